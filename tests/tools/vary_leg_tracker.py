#!/usr/bin/env python3
"""Writes 22 copies of a leg_tracker recording that differ a little: range noise, beams without echo, scans left out.
Figures of few rows scatter with any such change; compare their means.

usage: vary_leg_tracker.py RECORDING FOLDER
"""

import gzip
import pathlib
import random
import shutil
import sys

NO_ECHO = {"0", "nan", "inf"}
FIRST_RANGE = 5  # word of a line of scan.txt


def read(path):
    with gzip.open(path, "rt") if path.suffix == ".gz" else open(path) as file:
        return file.read().splitlines()


def changed(scans, seed, change):
    """The scans with each range r that is one replaced by change(r, random)."""
    generator = random.Random(seed)
    lines = []
    for scan in scans:
        words = scan.split()
        words[FIRST_RANGE:] = [word if word in NO_ECHO else change(float(word), generator) for word in words[FIRST_RANGE:]]
        lines.append(" ".join(words))
    return lines


def noisy(sigma_m):
    return lambda range_m, generator: f"{max(0.02, range_m + generator.gauss(0.0, sigma_m)):.3f}"


def dark(range_m, generator):
    return "inf" if generator.random() < 0.02 else f"{range_m:.3f}"


def variants(scans):
    yield "base", scans
    for seed in range(1, 10):
        yield f"noise{seed}", changed(scans, seed, noisy(0.005 if seed < 7 else 0.01))
    for seed in range(1, 4):
        yield f"dark{seed}", changed(scans, seed, dark)
    for first in (10, 25, 40, 60):
        yield f"late{first}", scans[first:]
    for every, phase in ((9, 1), (9, 4), (9, 7), (6, 2), (6, 5)):
        yield f"drop{every}_{phase}", [scan for i, scan in enumerate(scans) if i % every != phase]


def main(recording, folder):
    heading, *scans = read(next(recording.glob("scan.txt*")))
    for name, lines in variants(scans):
        copy = folder / name
        copy.mkdir(parents=True, exist_ok=True)
        (copy / "scan.txt").write_text("\n".join([heading, *lines]) + "\n")
        for other in [*recording.glob("odom.txt*"), recording / "people_gt.txt"]:
            shutil.copyfile(other, copy / other.name)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
