#!/usr/bin/env python3
"""Prints which share of the lines of each folder the tests ran, from the counts of a build with --coverage.

usage: coverage.py BUILD [--uncovered PREFIX]

BUILD was built with the preset coverage and its tests ran. --uncovered also lists the lines that none ran of files
whose path begins with PREFIX. Counts of one source in several programs are summed. A source that no program links is not
in the table.
"""

import argparse
import collections
import concurrent.futures
import json
import os
import subprocess
import sys
from pathlib import Path

FOLDERS = ("common/", "examples/", "services/")


def counts_of(data_file):
    """gcov's report of one object, as JSON."""
    done = subprocess.run(["gcov", "--json-format", "--stdout", str(data_file)], capture_output=True, text=True, check=False)
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def add(reports, root, lines):
    """Sums the reports into {path: {line number: count}}, for files of the tree's own code."""
    for report in reports:
        for file in report["files"]:
            path = os.path.relpath(os.path.join(report["current_working_directory"], file["file"]), root)
            if path.startswith(FOLDERS):
                for line in file["lines"]:
                    lines[path][line["line_number"]] += line["count"]


def share(counts):
    """(lines that ran, lines)"""
    return sum(1 for count in counts if count > 0), len(counts)


def by_folder(lines):
    folders = collections.defaultdict(list)
    for path, counts in lines.items():
        folders["/".join(path.split("/")[:2])] += list(counts.values())
    return {folder: share(counts) for folder, counts in sorted(folders.items())}


def table(folders):
    """One line a folder and their sum, as text."""
    total = [sum(column) for column in zip(*folders.values())]
    rows = [*folders.items(), ("all", tuple(total))]
    return "\n".join(f"{name:28}{ran:8}{lines:8}{100 * ran / lines:7.1f} %" for name, (ran, lines) in rows)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--uncovered", metavar="PREFIX")
    options = parser.parse_args(arguments)
    root = Path(__file__).resolve().parents[2]
    lines = collections.defaultdict(collections.Counter)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for reports in pool.map(counts_of, sorted(options.build.resolve().rglob("*.gcda"))):
            add(reports, root, lines)
    if not lines:
        print(f"error: {options.build} has no counts: build the preset coverage and run its tests", file=sys.stderr)
        return 1
    print(f"{'folder':28}{'ran':>8}{'lines':>8}{'share':>9}")
    print(table(by_folder(lines)))
    if options.uncovered:
        for path in sorted(path for path in lines if path.startswith(options.uncovered)):
            missed = sorted(number for number, count in lines[path].items() if count == 0)
            if missed:
                print(f"{path}: {' '.join(map(str, missed))}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
