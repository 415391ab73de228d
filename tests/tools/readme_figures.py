#!/usr/bin/env python3
"""Makes the figures of README.md's table "Results": runs the command of each row, evaluates it, and prints the figures beside those of the
page; --update writes them into it. Rows that `slammot eval` cannot judge (no clock) are left to tests/corpus/run, and named.

Usage: readme_figures.py SLAMMOT [--update] [--only WORD]"""

import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\| (?P<drive>[^|]+) \| (?P<ate>[\d.]+) m \| `slammot (?P<command>run [^`]+)` \|$")
SUFFIX = re.compile(r"(\.rawodom)?\.log(\.gz)?$")
TRACKS = re.compile(r"HOTA [\d.]+, MOTA [\d.]+")


def rows_in(page):
    return [match for match in map(ROW.match, page.splitlines()) if match]


def input_of(command):
    words = shlex.split(command)
    return words[words.index("--input") + 1]


def evaluate(slammot, command, folder):
    """The evaluation of the command's run, or None and why not."""
    log = input_of(command)
    words = shlex.split(command)
    words[words.index("--output") + 1] = folder
    for step in ([*words, "--quiet", "--no-report"], ["eval", "--result", folder, "--truth", SUFFIX.sub("", log)]):
        done = subprocess.run([slammot, *step], cwd=ROOT, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return None, (done.stderr.strip().splitlines() or ["failed"])[-1]
    return json.loads((pathlib.Path(folder) / "evaluation.json").read_text()), None


def row_with(match, evaluation):
    """The row with these figures."""
    ate = evaluation["trajectory"]["ate_m"]["rmse"]
    digits = len(match["ate"].split(".")[1])
    drive = match["drive"]
    tracking = evaluation.get("tracking")
    if tracking and TRACKS.search(drive):
        drive = TRACKS.sub(f"HOTA {tracking['hota']['hota']:.2f}, MOTA {tracking['clear_mot']['mota']:.2f}", drive)
    return f"| {drive} | {ate:.{digits}f} m | `slammot {match['command']}` |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("slammot", type=pathlib.Path)
    parser.add_argument("--update", action="store_true", help="write the figures into README.md")
    parser.add_argument("--only", default="", help="rows that hold this word")
    options = parser.parse_args()
    page = (ROOT / "README.md").read_text(encoding="utf-8")
    differs = False
    for match in rows_in(page):
        if options.only not in match[0]:
            continue
        with tempfile.TemporaryDirectory() as folder:
            evaluation, fault = evaluate(options.slammot.resolve(), match["command"], folder)
        if evaluation is None or not evaluation.get("trajectory"):
            print(f"not judged: {match['drive']}: {fault or 'no trajectory in the evaluation'}")
            continue
        row = row_with(match, evaluation)
        print(("same:    " if row == match[0] else "now:     ") + row, flush=True)
        differs = differs or row != match[0]
        page = page.replace(match[0], row)
    if options.update:
        (ROOT / "README.md").write_text(page, encoding="utf-8")
    sys.exit(1 if differs and not options.update else 0)


if __name__ == "__main__":
    main()
