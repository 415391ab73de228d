#!/usr/bin/env python3
"""Counts lines of files and functions and members of classes, and settings by group.

    tests/tools/sizes.py services/tracking services/localization
    build/release/bin/slammot config --page | tests/tools/sizes.py --settings

Files and functions are counted in lines, with their braces; functions are those that begin at the
left margin, as clang-format writes them. A class has the members of data that it declares itself."""

import argparse
import pathlib
import re
import statistics
import sys

NO_FUNCTION = re.compile(r"(namespace|class|struct|enum|union|extern|using|template)\b|[#/}]")
NO_MEMBER = re.compile(r"\s*(//|using|friend|static|return|public|private|protected|struct|class|enum|template|typedef)\b")


def functions(text):
    """(name, lines) of each function defined at the left margin."""
    found = []
    lines = text.splitlines()
    start = None
    for number, line in enumerate(lines):
        if start is None and line and not line[0].isspace() and not NO_FUNCTION.match(line):
            start = number
        if start is None:
            continue
        if line.endswith(";") and not any("{" in part for part in lines[start:number + 1]):
            start = None  # a declaration
        elif line == "}" or (number == start and line.endswith("}")):
            head = " ".join(lines[start:number + 1]).split("{")[0]
            name = re.search(r"([\w:~]+)\s*\(", head)
            if name:
                found.append((name.group(1), number - start + 1))
            start = None
        elif line in ("};", ");"):
            start = None  # a table of constants
    return found


def classes(text):
    """(name, members) of each class or struct, inner ones, too."""
    found = []
    open_classes = []  # name, indentation, members
    statement = ""
    for line in text.splitlines():
        code = line.split("//")[0].rstrip()
        indentation = len(line) - len(line.lstrip())
        head = re.match(r"\s*(?:class|struct) (\w+)[^;()]*\{$", code)
        if head:
            open_classes.append([head.group(1), indentation, 0])
            statement = ""
            continue
        if not open_classes:
            continue
        name, outer, members = open_classes[-1]
        if code.strip() == "};" and indentation == outer:
            found.append((name, members))
            open_classes.pop()
            continue
        if indentation == outer + 2 and not statement:
            statement = code
        elif statement:
            statement += " " + code.strip()
        if statement.endswith((";", "}", ":")):
            if is_member(statement):
                open_classes[-1][2] += 1
            statement = ""
    return found


def is_member(statement):
    """True for a declaration of data: no function, type or access."""
    if NO_MEMBER.match(statement) or not statement.endswith(";"):
        return False
    declared = re.split(r"[={]", statement, maxsplit=1)[0]
    return "(" not in re.sub(r"<[^;]*>", "", declared)


def row(title, counts):
    """Number, median and the largest with its name."""
    if not counts:
        return f"{title}: none"
    name, most = max(counts, key=lambda one: one[1])
    median = statistics.median(count for _, count in counts)
    return f"{title}: {len(counts)}, median {median:g}, max {most} ({name})"


def report(folder):
    """Lines of text on the C++ files directly in a folder."""
    files, found_functions, found_classes = [], [], []
    for path in sorted(folder.iterdir()):
        if path.suffix not in (".cpp", ".hpp"):
            continue
        text = path.read_text()
        files.append((path.name, len(text.splitlines())))
        found_functions += functions(text)
        found_classes += classes(text)
    return [str(folder), "  " + row("files", files), "  " + row("functions", found_functions),
            "  " + row("members", found_classes)]


def settings_by_group(page):
    """{group: settings} of the page that `slammot config --page` prints."""
    counts = {}
    group = None
    for line in page.splitlines():
        if line.startswith("## "):
            group = line[3:].split(":")[0]
            counts[group] = 0
        elif group is not None and line.startswith("| `"):
            counts[group] += 1
    return counts


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="*", type=pathlib.Path)
    parser.add_argument("--settings", action="store_true", help="count the settings of the page on standard input")
    options = parser.parse_args(arguments)
    for folder in options.folders:
        print("\n".join(report(folder)))
    if options.settings:
        counts = settings_by_group(sys.stdin.read())
        print("\n".join(f"{group}: {count}" for group, count in counts.items()))
        print(f"all: {sum(counts.values())}")


if __name__ == "__main__":
    main(sys.argv[1:])
