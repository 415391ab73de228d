"""Spoils a CARMEN log of ROBOTLASER1 lines, as `slammot simulate` writes it, the way sensors do."""

import math

POSES_AFTER = 2  # of the laser and of the base, after the ranges and the remissions


class Scan:
    """One ROBOTLASER1 line, with what is spoiled at hand."""

    def __init__(self, line):
        self.words = line.split()
        self.beams = int(self.words[8])
        self.first_range = 9

    @staticmethod
    def is_scan(line):
        return line.startswith("ROBOTLASER1 ")

    @property
    def first_pose(self):
        remissions = int(self.words[self.first_range + self.beams])
        return self.first_range + self.beams + 1 + remissions

    @property
    def stamp_s(self):
        return float(self.words[-3])

    def line(self):
        return " ".join(self.words) + "\n"

    def keep_echoes(self, kept):
        """All other beams have no echo."""
        no_echo = self.words[5]  # the scanner's maximum range
        for beam in range(self.beams):
            if beam not in kept:
                self.words[self.first_range + beam] = no_echo

    def pose(self, which):
        """0: of the laser, 1: of the base, in the wheels' frame."""
        at = self.first_pose + 3 * which
        return tuple(float(word) for word in self.words[at:at + 3])

    def move_wheels(self, moved_from_wheels):
        """The odometry as if its origin were elsewhere."""
        for which in range(POSES_AFTER):
            at = self.first_pose + 3 * which
            self.words[at:at + 3] = [f"{number:.6f}" for number in chained(moved_from_wheels, self.pose(which))]


def chained(a, b):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], math.remainder(a[2] + b[2], 2 * math.pi))


def inverse(a):
    c, s = math.cos(a[2]), math.sin(a[2])
    return (-c * a[0] - s * a[1], s * a[0] - c * a[1], -a[2])


def swap(scans, first, count):
    """`count` scans come in reverse order."""
    scans[first:first + count] = reversed(scans[first:first + count])


def repeat(scans, at, times):
    """With the same stamp, and one reading changed in each: those that are the same are left out when the log is opened."""
    again = [Scan(scans[at].line()) for _ in range(times)]
    for number, scan in enumerate(again):
        scan.words[scan.first_range] = f"{1.0 + 0.01 * number:.2f}"
    scans[at:at] = again


def leave_out(scans, first, duration_s):
    end = first
    while scans[end].stamp_s - scans[first].stamp_s < duration_s:
        end += 1
    del scans[first:end]


def blind(scans, first, count, kept=()):
    for scan in scans[first:first + count]:
        scan.keep_echoes(set(kept))


def stamp(scans, at, ahead_s):
    """One scan, and its odometry, claim to be from the future."""
    for word in (-3, -1):
        scans[at].words[word] = f"{float(scans[at].words[word]) + ahead_s:.6f}"


def jump(scans, first, ahead, left, heading):
    """From one scan to the next the wheels say that the vehicle has gone so far more."""
    base = scans[first].pose(1)
    moved_from_wheels = chained(chained(base, (ahead, left, heading)), inverse(base))
    for scan in scans[first:]:
        scan.move_wheels(moved_from_wheels)


def read(path):
    with open(path, encoding="ascii") as file:
        lines = file.readlines()
    head = [line for line in lines if not Scan.is_scan(line)]
    return head, [Scan(line) for line in lines if Scan.is_scan(line)]


def write(path, head, scans):
    with open(path, "w", encoding="ascii") as file:
        file.writelines(head)
        file.writelines(scan.line() for scan in scans)
