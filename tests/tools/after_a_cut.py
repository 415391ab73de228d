#!/usr/bin/env python3
"""Reports when a drive relocalized after tests/tools/alter_drive.py cut a piece out of it, and its position error from then on.

usage: after_a_cut.py COPY RESULT FROM     FROM as given to alter_drive.py --cut, in s since the first scan

Errors are in the frame of the drive's first pose. "Found after" is the time from the first pose after the cut to the last
pose of online.tum with an error above 1 m. Errors are of trajectory.tum from 8 s after the cut on, median and worst.
"""

import math
import pathlib
import statistics
import sys

OFF_M = 1.0
FROM_THEN_ON_S = 8.0


def read(path):
    """Poses (x, y, heading) by stamp in microseconds."""
    poses = {}
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith("#"):
            continue
        stamp, x, y, _, _, _, qz, qw = (float(word) for word in line.split())
        poses[round(stamp * 1e6)] = (x, y, 2 * math.atan2(qz, qw))
    return poses


def seen_from(first, pose):
    dx, dy = pose[0] - first[0], pose[1] - first[1]
    cosine, sine = math.cos(first[2]), math.sin(first[2])
    return cosine * dx + sine * dy, -sine * dx + cosine * dy


def errors(estimated, true):
    """Pairs of a stamp (s since the first) and how far off the estimate is (m), where both have a pose."""
    stamps = sorted(set(estimated) & set(true))
    first = stamps[0]
    return [((stamp - first) / 1e6, math.dist(seen_from(estimated[first], estimated[stamp]), seen_from(true[first], true[stamp])))
            for stamp in stamps]


def main(copy, result, from_s):
    true = read(copy + ".tum")
    live, later = (errors(read(pathlib.Path(result) / name), true) for name in ("online.tum", "trajectory.tum"))
    begin_s = next(since_s for since_s, _ in live if since_s >= from_s)
    off_s = [since_s for since_s, error_m in live if since_s >= begin_s and error_m > OFF_M]
    if off_s and off_s[-1] == live[-1][0]:
        found = "not found"
    else:
        found = f"found after {off_s[-1] - begin_s if off_s else 0.0:.0f} s"
    errors_m = [error_m for since_s, error_m in later if since_s >= begin_s + FROM_THEN_ON_S]
    print(f"{found}, error {statistics.median(errors_m):.2f} m in the median, {max(errors_m):.2f} m at worst")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    try:
        main(sys.argv[1], sys.argv[2], float(sys.argv[3]))
    except OSError as fault:
        sys.exit(f"{fault.filename}: {fault.strerror}")
