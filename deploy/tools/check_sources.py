#!/usr/bin/env python3
"""Runs clang over C++ sources of a configured build, in parallel, and prints what it finds.

usage: check_sources.py BUILD {syntax,tidy} [--changed BASE] [--part PREFIX]... [FILE...]

BUILD is a folder with compile_commands.json, configured for clang, whose precompiled and generated headers are built.
syntax compiles without output, with warnings as errors; with --changed or files without the precompiled headers, so that a source
that does not include what it uses is found (all sources would take half an hour). tidy runs clang-tidy with the tree's .clang-tidy,
without the precompiled headers: it walks through every declaration that a source includes, and those hold more than a source needs.
Without files: every source. --part keeps those whose path begins with PREFIX. --changed keeps those that differ from
the merge base with BASE, and those that include a changed header directly. Exit code 1 if anything is found.
"""

import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

FOLDERS = ("common/", "examples/", "services/", "tests/")


def commands_of(build, root):
    """{path from the root: (folder, words)} of the tree's own sources."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        path = os.path.relpath(os.path.join(entry["directory"], entry["file"]), root)
        if path.startswith(FOLDERS):
            commands[path] = (entry["directory"], shlex.split(entry["command"]))
    return commands


def without_output(words):
    """The same command, as a check of syntax and warnings."""
    kept = []
    skip_next = False
    for word in words:
        if skip_next:
            skip_next = False
        elif word in ("-o", "-MF", "-MT", "-MQ"):
            skip_next = True
        elif word not in ("-MD", "-c"):
            kept.append(word)
    return without_launcher(kept) + ["-Werror", "-fsyntax-only"]


def without_launcher(words):
    """Drops ccache and the environment it is given, up to the compiler."""
    for i, word in enumerate(words):
        if re.search(r"(^|/)(clang|clang\+\+|c\+\+|g\+\+)(-\d+)?$", word):
            return words[i:]
    return words


def without_precompiled_headers(words):
    """The same command without what CMake adds of clang for a precompiled header."""
    kept = []
    words = iter(words)
    for word in words:
        if word == "-Xclang":
            argument = next(words)
            if argument in ("-include-pch", "-include"):
                next(words), next(words)  # -Xclang and the file
            else:
                kept += [word, argument]
        elif word != "-Winvalid-pch":
            kept.append(word)
    return kept


def write_database(commands, folder):
    """compile_commands.json for clang-tidy in the folder."""
    entries = [{"directory": directory, "file": words[-1], "arguments": without_launcher(without_precompiled_headers(words))}
               for directory, words in commands.values()]
    (folder / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")


def changed_files(root, base):
    """Paths that differ from the merge base with a branch, committed or not."""
    def git(*words):
        return subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True, check=True).stdout
    since = git("merge-base", base, "HEAD").strip()
    named = git("diff", "--name-only", since) + git("ls-files", "--others", "--exclude-standard")
    return set(named.split())


def affected(sources, changed, root):
    """Sources that changed or include a changed header."""
    headers = {path for path in changed if path.endswith(".hpp")}

    def includes_one(path):
        text = (root / path).read_text(encoding="utf-8")
        return any(name in headers for name in re.findall(r'#include "([^"]+)"', text))
    return [path for path in sources if path in changed or (headers and includes_one(path))]


def selected(sources, options, root):
    if options.files:
        wanted = {os.path.relpath(os.path.abspath(name), root) for name in options.files}
        unknown = wanted - set(sources)
        if unknown:
            sys.exit(f"error: no sources of this build: {', '.join(sorted(unknown))}")
        sources = [path for path in sources if path in wanted]
    if options.part:
        sources = [path for path in sources if path.startswith(tuple(options.part))]
    if options.changed:
        sources = affected(sources, changed_files(root, options.changed), root)
    return sources


def check(path, command, kind, root, database):
    """(path, whether it is clean, what was printed)"""
    folder, words = command
    if kind == "syntax":
        done = subprocess.run(without_output(words), cwd=folder, capture_output=True, text=True, check=False)
    else:
        done = subprocess.run(["clang-tidy", "--quiet", "-p", database, str(root / path)],
                              capture_output=True, text=True, check=False)
    is_clean = done.returncode == 0
    return path, is_clean, "" if is_clean else done.stdout + done.stderr


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("kind", choices=("syntax", "tidy"))
    parser.add_argument("--changed", metavar="BASE")
    parser.add_argument("--part", action="append", metavar="PREFIX")
    parser.add_argument("files", nargs="*")
    return parser.parse_args(arguments)


def main(arguments, root=Path(__file__).resolve().parents[2]):
    options = parse(arguments)
    commands = commands_of(options.build.resolve(), root)
    sources = selected(sorted(commands), options, root)
    if not sources:
        if options.changed and commands:
            print("no source changed")
            return 0
        print("error: there is nothing to check", file=sys.stderr)
        return 2
    if options.files or options.changed:
        commands = {path: (folder, without_precompiled_headers(words)) for path, (folder, words) in commands.items()}
    began = time.monotonic()
    faulty = 0
    with tempfile.TemporaryDirectory() as database, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        write_database({path: commands[path] for path in sources}, Path(database))
        for path, is_clean, text in pool.map(lambda path: check(path, commands[path], options.kind, root, database), sources):
            if not is_clean:
                faulty += 1
                print(f"{path}:\n{text}", flush=True)
    print(f"{options.kind}: {len(sources)} sources, {faulty} with findings, {time.monotonic() - began:.0f} s")
    return 1 if faulty else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
