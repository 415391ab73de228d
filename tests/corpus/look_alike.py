"""Counts pairs of places in a drive that look alike to the scanner and are not the same."""

import math

import carmen_drive

EVERY_M = 2.0
APART_M = 6.0
ALIKE_M = 0.3
ALIKE_SHARE = 0.8
BEAMS = 45


def places(drive, poses):
    """(pose, ranges of few beams) once every two metres."""
    found, last = [], None
    for scan, pose in zip(drive.scans(), poses):
        if pose is None or (last is not None and math.dist(pose[:2], last[:2]) < EVERY_M):
            continue
        last = pose
        every = max(1, len(scan.ranges) // BEAMS)
        found.append((pose, [carmen_drive.number(word) for word in scan.ranges[::every]]))
    return found


def alike(a, b):
    same = sum(abs(one - other) < ALIKE_M for one, other in zip(a, b))
    return same >= ALIKE_SHARE * min(len(a), len(b))


def pairs(drive, poses):
    known = places(drive, poses)
    return sum(math.dist(pose[:2], other[:2]) > APART_M and alike(ranges, other_ranges)
               for index, (pose, ranges) in enumerate(known) for other, other_ranges in known[:index])
