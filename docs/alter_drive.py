#!/usr/bin/env python3
"""Writes a copy of a recorded drive (a CARMEN log of ROBOTLASER1 lines, and its true poses) as it was not driven: COPY.log and COPY.tum.

usage: alter_drive.py PREFIX COPY --cut FROM TO [--no-time-passes]   carried away: the scans from FROM to TO (s since the first) are
                                                                     missing, the wheels stand meanwhile
       alter_drive.py PREFIX COPY --odometry-late S                  each scan has the odometry of S seconds before it (S < 0: after it)

PREFIX.log and PREFIX.tum, each plain or .gz, are read. With --no-time-passes stamps go on after the cut as if there were none.
"""

import argparse
import bisect
import gzip
import math
import pathlib
import sys

POSES = (-14, -11)  # words of a ROBOTLASER1 line where x (m), y (m) and heading (rad) of the laser and of the robot begin
STAMPS = (-3, -1)  # words that hold the stamp (s)


def read(prefix, extension):
    plain = pathlib.Path(prefix + extension)
    with open(plain) if plain.exists() else gzip.open(prefix + extension + ".gz", "rt") as file:
        return file.read().splitlines()


def stamp_of(words):
    return float(words[STAMPS[0]])


def pose_of(words, first):
    return tuple(float(word) for word in words[first:first + 3])


def with_poses(words, poses):
    changed = list(words)
    for first, pose in zip(POSES, poses):
        changed[first:first + 3] = [f"{value:.6f}" for value in pose]
    return changed


def compound(a, b):
    """a_from_c = a_from_b * b_from_c, poses of (x, y, heading)."""
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return a[0] + cosine * b[0] - sine * b[1], a[1] + sine * b[0] + cosine * b[1], a[2] + b[2]


def inverse(a):
    cosine, sine = math.cos(a[2]), math.sin(a[2])
    return -cosine * a[0] - sine * a[1], sine * a[0] - cosine * a[1], -a[2]


def between(a, b, share):
    turn = math.remainder(b[2] - a[2], 2 * math.pi)
    return a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * turn


def late(scans, lateness_s):
    stamps = [stamp_of(words) for words in scans]
    changed = []
    for stamp, words in zip(stamps, scans):
        wanted = min(max(stamp - lateness_s, stamps[0]), stamps[-1])
        after = min(max(bisect.bisect_left(stamps, wanted), 1), len(stamps) - 1)
        share = (wanted - stamps[after - 1]) / (stamps[after] - stamps[after - 1])
        changed.append(with_poses(words, [between(pose_of(scans[after - 1], p), pose_of(scans[after], p), share) for p in POSES]))
    return changed


def cut(scans, from_s, to_s):
    start = stamp_of(scans[0])
    before = [words for words in scans if stamp_of(words) < start + from_s]
    after = [words for words in scans if stamp_of(words) >= start + to_s]
    moved = []
    for p in POSES:
        last_from_first = compound(pose_of(before[-1], p), inverse(pose_of(after[0], p)))
        moved.append([compound(last_from_first, pose_of(words, p)) for words in after])
    return before, [with_poses(words, poses) for words, *poses in zip(after, *moved)]


def sooner(scans, by_s):
    changed = [list(words) for words in scans]
    for words in changed:
        for stamp in STAMPS:
            words[stamp] = f"{float(words[stamp]) - by_s:.6f}"
    return changed


def cut_truth(truth, start, from_s, to_s, sooner_by_s):
    kept = []
    for line in truth:
        words = line.split()
        since_s = float(words[0]) - start
        if since_s < from_s:
            kept.append(line)
        elif since_s >= to_s:
            kept.append(" ".join([f"{float(words[0]) - sooner_by_s:.6f}", *words[1:]]))
    return kept


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("prefix")
    parser.add_argument("copy")
    parser.add_argument("--cut", nargs=2, type=float, metavar=("FROM", "TO"))
    parser.add_argument("--no-time-passes", action="store_true")
    parser.add_argument("--odometry-late", type=float, metavar="S")
    options = parser.parse_args()
    if (options.cut is None) == (options.odometry_late is None):
        parser.error("one of --cut and --odometry-late is needed")

    log = read(options.prefix, ".log")
    heading = [line for line in log if not line.startswith("ROBOTLASER1 ")]
    scans = [line.split() for line in log if line.startswith("ROBOTLASER1 ")]
    truth = [line for line in read(options.prefix, ".tum") if not line.startswith("#")]
    if options.cut:
        before, after = cut(scans, *options.cut)
        usual_step_s = stamp_of(before[-1]) - stamp_of(before[-2])
        gap_s = stamp_of(after[0]) - stamp_of(before[-1]) - usual_step_s if options.no_time_passes else 0.0
        truth = cut_truth(truth, stamp_of(scans[0]), *options.cut, gap_s)
        scans = before + sooner(after, gap_s)
    else:
        scans = late(scans, options.odometry_late)
    copy = pathlib.Path(options.copy)
    copy.parent.mkdir(parents=True, exist_ok=True)
    pathlib.Path(options.copy + ".log").write_text("\n".join(heading + [" ".join(words) for words in scans]) + "\n")
    pathlib.Path(options.copy + ".tum").write_text("\n".join(truth) + "\n")


if __name__ == "__main__":
    try:
        main()
    except OSError as fault:
        sys.exit(f"{fault.filename}: {fault.strerror}")
