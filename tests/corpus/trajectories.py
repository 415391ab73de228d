"""Compares a trajectory with the true one, scan by scan. Poses are (x [m], y [m], heading [rad]); None: not known."""

import bisect
import math

OFF_M = 1.0
OFF_RAD = 0.2
SETTLED_SCANS = 10  # before the alignment of what was driven so far says something
SETTLED_M = 2.0
JOINED_M = 1.0  # places that the estimate puts this near to each other are one place to it
APART_WAY_M = 20.0


def positions_in_pairs(estimated, true):
    return [(index, a, b) for index, (a, b) in enumerate(zip(estimated, true))
            if a is not None and b is not None and all(map(math.isfinite, a[:2]))]


class Alignment:
    """The rigid motion that brings estimated positions onto true ones with the least squares, from sums (Umeyama 1991, in the plane)."""

    def __init__(self):
        self.n = self.ax = self.ay = self.bx = self.by = self.dot = self.cross = 0.0

    def add(self, a, b):
        self.n += 1
        self.ax += a[0]
        self.ay += a[1]
        self.bx += b[0]
        self.by += b[1]
        self.dot += a[0] * b[0] + a[1] * b[1]
        self.cross += a[0] * b[1] - a[1] * b[0]

    def true_from_estimated(self):
        dot = self.dot - (self.ax * self.bx + self.ay * self.by) / self.n
        cross = self.cross - (self.ax * self.by - self.ay * self.bx) / self.n
        heading = math.atan2(cross, dot)
        cosine, sine = math.cos(heading), math.sin(heading)
        return ((self.bx - cosine * self.ax + sine * self.ay) / self.n, (self.by - sine * self.ax - cosine * self.ay) / self.n, heading)


def moved(motion, pose):
    cosine, sine = math.cos(motion[2]), math.sin(motion[2])
    return motion[0] + cosine * pose[0] - sine * pose[1], motion[1] + sine * pose[0] + cosine * pose[1], pose[2] + motion[2]


def aligned(estimated, true):
    """The estimated poses in the frame of the true ones."""
    alignment = Alignment()
    for _, a, b in positions_in_pairs(estimated, true):
        alignment.add(a, b)
    motion = alignment.true_from_estimated() if alignment.n else (0.0, 0.0, 0.0)
    return [a and moved(motion, a) for a in estimated]


def ate(estimated, true):
    """Root mean square and greatest distance [m] after rigid alignment; NaN where nothing can be compared."""
    pairs = positions_in_pairs(aligned(estimated, true), true)
    errors = [math.dist(a[:2], b[:2]) for _, a, b in pairs]
    if not errors:
        return math.nan, math.nan
    return math.sqrt(sum(error * error for error in errors) / len(errors)), max(errors)


def off_share(estimated, true, off_m=OFF_M):
    """Share of the poses that are off by more than a metre when all are aligned; None where nothing can be compared."""
    pairs = positions_in_pairs(aligned(estimated, true), true)
    return sum(math.dist(a[:2], b[:2]) > off_m for _, a, b in pairs) / len(pairs) if pairs else None


def seen_from(first, pose):
    cosine, sine = math.cos(first[2]), math.sin(first[2])
    dx, dy = pose[0] - first[0], pose[1] - first[1]
    return cosine * dx + sine * dy, -sine * dx + cosine * dy, math.remainder(pose[2] - first[2], 2 * math.pi)


def ways_of(poses):
    ways = [0.0]
    for a, b in zip(poses, poses[1:]):
        ways.append(ways[-1] + math.dist(a[:2], b[:2]))
    return ways


def drift(estimated, true, over_m):
    """Mean error [m] of the motion between each pose and the one over_m of the true path later; NaN where there is no such pair."""
    pairs = positions_in_pairs(estimated, true)
    ways = ways_of([b for _, _, b in pairs])
    errors = []
    for first, (_, a, b) in enumerate(pairs):
        last = bisect.bisect_left(ways, ways[first] + over_m)
        if last < len(ways) and ways[last] - ways[first] <= 1.1 * over_m:
            errors.append(math.dist(seen_from(a, pairs[last][1])[:2], seen_from(b, pairs[last][2])[:2]))
    return sum(errors) / len(errors) if errors else math.nan


def first_off(estimated, true, off_m=OFF_M, off_rad=OFF_RAD):
    """The first scan whose pose is off by a metre or 0.2 rad, as (index, metres, radians), when all scans before it are aligned;
    None where there is none."""
    alignment = Alignment()
    turns = [0.0, 0.0]
    pairs = positions_in_pairs(estimated, true)
    start = pairs[0][2] if pairs else None
    went_m = 0.0
    for count, (index, a, b) in enumerate(pairs):
        if count >= SETTLED_SCANS and went_m >= SETTLED_M:
            error_m = math.dist(moved(alignment.true_from_estimated(), a)[:2], b[:2])
            error_rad = abs(math.remainder(b[2] - a[2] - math.atan2(turns[1], turns[0]), 2 * math.pi))
            if error_m > off_m or error_rad > off_rad:
                return index, error_m, error_rad
        alignment.add(a, b)
        turns[0] += math.cos(b[2] - a[2])
        turns[1] += math.sin(b[2] - a[2])
        went_m = max(went_m, math.dist(start[:2], b[:2]))
    return None


def falsely_joined(estimated, true, off_m=OFF_M):
    """Pairs of places (one each metre of the way) that the estimate puts within a metre of each other and that truly lie elsewhere to
    each other, by more than off_m: what a false closure that lasts leaves behind."""
    pairs = positions_in_pairs(estimated, true)
    ways = ways_of([b for _, _, b in pairs])
    places, next_m = [], 0.0
    for (_, a, b), way_m in zip(pairs, ways):
        if way_m >= next_m:
            places.append((way_m, a, b))
            next_m = way_m + 1.0
    cells = {}
    count = 0
    for way_m, a, b in places:
        cell = math.floor(a[0] / JOINED_M), math.floor(a[1] / JOINED_M)
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                for other_m, other_a, other_b in cells.get((cell[0] + dx, cell[1] + dy), ()):
                    if way_m - other_m < APART_WAY_M or math.dist(a[:2], other_a[:2]) > JOINED_M:
                        continue
                    count += math.dist(seen_from(other_a, a)[:2], seen_from(other_b, b)[:2]) > off_m
        cells.setdefault(cell, []).append((way_m, a, b))
    return count
