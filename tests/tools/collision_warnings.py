#!/usr/bin/env python3
"""Judges the warnings of `slammot warn` on simulated drives with a danger, and on drives without one.

usage: collision_warnings.py [--seeds 1-20] [--scenario NAME ...] [--output DIR] [--binary FILE] [--config FILE] [--again] [--write] [--check [--known-false N]]

A danger is an object whose true footprint comes within 0.3 m of the vehicle's. It counts as warned if a track of that object has the level
`warning` at least 2 s before. A warning of an object that does not come so near within 5 s is without contact. It is averted if both were truly
on course for one at the warning or up to 0.5 s before: they would have come so near within 4 s if both had gone on as they did, braking until
they stand, so that a contact was kept away by the driver or the other one. Otherwise the warning is false.
"""

import argparse
import bisect
import collections
import csv
import dataclasses
import math
import pathlib
import subprocess
import sys

from tables import seeds_in

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS_PAGE = ROOT / "docs" / "results.md"
HEADING, BEGIN, END = "## Collision warnings", "<!-- collision warnings: begin -->", "<!-- collision warnings: end -->"
DANGERS = ["collision_braking", "collision_pedestrian", "collision_crossing", "collision_cut_in"]
HARMLESS = ["near_braking", "near_pedestrian", "near_crossing", "near_cut_in"]
ORDINARY = ["block", "city", "quiet"]

NEAR_M = 0.3          # a contact
WARNED_BEFORE_S = 2.0
LONGEST_BEFORE_S = 5.0  # an earlier warning is of something else
PAUSE_S = 1.0         # a level that returns later is another warning
MATCH_M = 4.0         # of a track's centre to that of its true object
COURSE_S = 4.0
COURSE_BEFORE_S = 0.5  # filters follow later, and a level is confirmed
WANTED_SHARE, WANTED_PER_HOUR = 0.95, 1.0
CITY_CAR, SCRIPT_CAR = (5.0, 2.0), (4.4, 1.8)  # length and width: RouteConfig and usual_size() of common/simulation


@dataclasses.dataclass
class Box:
    x: float
    y: float
    heading: float
    length: float
    width: float
    speed: float = 0.0

    def corners(self):
        c, s = math.cos(self.heading), math.sin(self.heading)
        for a, b in ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)):
            yield self.x + a * self.length * c - b * self.width * s, self.y + a * self.length * s + b * self.width * c

    def distance_to(self, x, y):
        c, s = math.cos(self.heading), math.sin(self.heading)
        ahead, left = c * (x - self.x) + s * (y - self.y), c * (y - self.y) - s * (x - self.x)
        return math.hypot(max(0.0, abs(ahead) - 0.5 * self.length), max(0.0, abs(left) - 0.5 * self.width))

    def after(self, seconds, acceleration, yaw_rate):
        """Along an arc; braking ends at rest."""
        if self.speed * acceleration < 0.0:
            seconds = min(seconds, -self.speed / acceleration)
        way = self.speed * seconds + 0.5 * acceleration * seconds * seconds
        turn = yaw_rate * seconds
        chord = way * (math.sin(0.5 * turn) / (0.5 * turn) if abs(turn) > 1e-9 else 1.0)
        return dataclasses.replace(self, x=self.x + chord * math.cos(self.heading + 0.5 * turn), y=self.y + chord * math.sin(self.heading + 0.5 * turn),
                                   heading=self.heading + turn)


def overlap(a, b):
    """Separating axes."""
    for box in (a, b):
        for angle in (box.heading, box.heading + math.pi / 2):
            c, s = math.cos(angle), math.sin(angle)
            of_a, of_b = ([c * x + s * y for x, y in box_.corners()] for box_ in (a, b))
            if max(of_a) < min(of_b) or max(of_b) < min(of_a):
                return False
    return True


def distance(a, b):
    if overlap(a, b):
        return 0.0
    return min(min(a.distance_to(*corner) for corner in b.corners()), min(b.distance_to(*corner) for corner in a.corners()))


def far(a, b, reach):
    return math.hypot(a.x - b.x, a.y - b.y) > reach + 0.5 * (math.hypot(a.length, a.width) + math.hypot(b.length, b.width))


def read_poses(path):
    """{stamp: (x, y, heading)}"""
    with open(path) as file:
        rows = [line.split() for line in file if not line.startswith("#")]
    return {row[0]: (float(row[1]), float(row[2]), 2.0 * math.atan2(float(row[6]), float(row[7]))) for row in rows}


class Drive:
    """A run with its truth. Stamps are texts: those of one scan are the same in all files."""

    def __init__(self, folder, size):
        self.true_poses = read_poses(folder / "truth.tum")
        self.poses = read_poses(folder / "online.tum")
        self.stamps = list(self.true_poses)
        self.times = [float(stamp) for stamp in self.stamps]
        self.size = size
        self.objects = collections.defaultdict(dict)  # stamp -> id -> box
        with open(folder / "truth.objects.csv", newline="") as file:
            for row in csv.DictReader(file):
                x, y, yaw, speed, length, width = (float(row[name]) for name in ("x", "y", "yaw", "speed", "length", "width"))
                self.objects[row["timestamp"]][row["id"]] = Box(x, y, yaw, length, width, speed)
        self.tracks = {}
        with open(folder / "tracks.csv", newline="") as file:
            for row in csv.DictReader(file):
                self.tracks[row["timestamp"], row["track_id"]] = float(row["x"]), float(row["y"])
        with open(folder / "collision_warnings.csv", newline="") as file:
            self.rows = list(csv.DictReader(file))

    def seconds(self):
        return self.times[-1] - self.times[0]

    def vehicle(self, stamp):
        i = bisect.bisect_left(self.times, float(stamp))
        before, after = max(0, i - 2), min(len(self.times) - 1, i + 2)
        x, y, heading = self.true_poses[stamp]
        (ax, ay, _), (bx, by, _) = (self.true_poses[self.stamps[j]] for j in (before, after))
        speed = ((bx - ax) * math.cos(heading) + (by - ay) * math.sin(heading)) / (self.times[after] - self.times[before])
        return Box(x, y, heading, *self.size, speed)

    def contacts(self):
        """{object: stamp in seconds at which it first comes near}"""
        first = {}
        for stamp in self.stamps:
            vehicle = None
            for name, box in self.objects.get(stamp, {}).items():
                x, y, _ = self.true_poses[stamp]
                if name in first or abs(box.x - x) > 15.0 or abs(box.y - y) > 15.0:
                    continue
                vehicle = vehicle or self.vehicle(stamp)
                if not far(vehicle, box, NEAR_M) and distance(vehicle, box) < NEAR_M:
                    first[name] = float(stamp)
        return first

    def object_of(self, stamp, track):
        """The true object nearest to the track, both as seen from the vehicle."""
        if (stamp, track) not in self.tracks or stamp not in self.poses or stamp not in self.true_poses:
            return None
        (tx, ty), (mx, my, mh), (wx, wy, wh) = self.tracks[stamp, track], self.poses[stamp], self.true_poses[stamp]
        turn = wh - mh
        x = wx + math.cos(turn) * (tx - mx) - math.sin(turn) * (ty - my)
        y = wy + math.sin(turn) * (tx - mx) + math.cos(turn) * (ty - my)
        near = [(math.hypot(box.x - x, box.y - y), name) for name, box in self.objects.get(stamp, {}).items()]
        near = [(box_m, name) for box_m, name in near if box_m < MATCH_M]
        return min(near)[1] if near else None

    def warnings(self):
        """(stamp of its begin, its end [s], track) of each."""
        open_, ended = {}, []
        for row in self.rows:
            if row["level"] != "warning":
                continue
            now = float(row["timestamp"])
            warning = open_.get(row["track_id"])
            if warning and now - warning[1] <= PAUSE_S:
                warning[1] = now
            else:
                open_[row["track_id"]] = [row["timestamp"], now, row["track_id"]]
                ended.append(open_[row["track_id"]])
        return ended

    def motion(self, stamp, name):
        """The object's box, acceleration and yaw rate, by what it did in the half second before; likewise the vehicle's."""
        earlier = self.stamps[max(0, bisect.bisect_left(self.times, float(stamp) - 0.5))]
        now, before = self.objects[stamp].get(name), self.objects.get(earlier, {}).get(name)
        return rates(now, before or now, float(stamp) - float(earlier)), rates(self.vehicle(stamp), self.vehicle(earlier), float(stamp) - float(earlier))

    def was_on_course(self, stamp, name):
        """At a stamp or shortly before."""
        last = bisect.bisect_right(self.times, float(stamp))
        first = bisect.bisect_left(self.times, float(stamp) - COURSE_BEFORE_S)
        return any(self.is_on_course(self.stamps[i], name) for i in range(first, last))

    def is_on_course(self, stamp, name):
        if name not in self.objects.get(stamp, {}):
            return False
        (box, *of_object), (vehicle, *of_vehicle) = self.motion(stamp, name)
        return any(distance(vehicle.after(0.1 * i, *of_vehicle), box.after(0.1 * i, *of_object)) < NEAR_M for i in range(int(COURSE_S / 0.1) + 1))


def rates(now, before, seconds):
    if seconds <= 0.0:
        return now, 0.0, 0.0
    turn = math.remainder(now.heading - before.heading, 2.0 * math.pi)
    return now, (now.speed - before.speed) / seconds, turn / seconds


@dataclasses.dataclass
class Verdict:
    seconds: float = 0.0
    dangers: int = 0
    warned: int = 0       # in time
    leads: list = dataclasses.field(default_factory=list)  # of each danger, seconds; 0 where there was no warning
    averted: int = 0
    false: int = 0
    details: list = dataclasses.field(default_factory=list)

    def add(self, other):
        self.seconds += other.seconds
        self.dangers += other.dangers
        self.warned += other.warned
        self.leads += other.leads
        self.averted += other.averted
        self.false += other.false
        self.details += other.details
        return self


def judge(drive):
    verdict = Verdict(seconds=drive.seconds())
    contacts = drive.contacts()
    begins = collections.defaultdict(list)
    for stamp, _, track in drive.warnings():
        name, now = drive.object_of(stamp, track), float(stamp)
        if name in contacts and now - 1.0 <= contacts[name] <= now + LONGEST_BEFORE_S:
            begins[name].append(now)
            continue
        is_averted = drive.was_on_course(stamp, name)
        verdict.averted += is_averted
        verdict.false += not is_averted
        verdict.details.append(f"{'averted' if is_averted else 'false'} warning at {stamp} of track {track}, object {name}")
    for name, contact in contacts.items():
        lead = max([contact - begin for begin in begins[name]], default=0.0)
        verdict.dangers += 1
        verdict.leads.append(max(0.0, lead))
        verdict.warned += lead >= WARNED_BEFORE_S
        if lead < WARNED_BEFORE_S:
            verdict.details.append(f"contact with object {name} at {contact:.2f}: warned {lead:.2f} s before")
    return verdict


def run(options, scenario, seed):
    folder = pathlib.Path(options.output) / f"{scenario}-{seed}"
    say = {"check": True, "stdout": subprocess.DEVNULL}
    if not options.again or not (folder / "tracks.csv").exists():
        subprocess.run([options.binary, "run", "--scenario", scenario, "--seed", str(seed), "--output", folder], **say)
    subprocess.run([options.binary, "warn", "--result", folder, *(["--config", options.config] if options.config else [])], **say)
    verdict = judge(Drive(folder, CITY_CAR if scenario in ORDINARY else SCRIPT_CAR))
    for line in verdict.details:
        print(f"{scenario} --seed {seed}: {line}", file=sys.stderr)
    return verdict


def row(name, verdict):
    hours = verdict.seconds / 3600.0
    leads = sorted(verdict.leads)
    warned = f"{verdict.warned} of {verdict.dangers}" if verdict.dangers else ""
    middle = f"{leads[len(leads) // 2]:.1f} / {leads[0]:.1f}" if leads else ""
    return f"| {name} | {60.0 * hours:.1f} | {warned} | {middle} | {verdict.averted} | {verdict.false} | {verdict.false / hours:.1f} |"


def table(verdicts):
    lines = ["| scenario | driven (min) | dangers warned of ≥ 2 s before | lead, median / least (s) | averted | false warnings | false an hour |",
             "|---|---|---|---|---|---|---|"]
    return "\n".join(lines + [row(name, verdict) for name, verdict in verdicts] + [row("**all**", total(verdicts))])


def total(verdicts):
    everything = Verdict()
    for _, verdict in verdicts:
        everything.add(dataclasses.replace(verdict, leads=list(verdict.leads), details=[]))
    return everything


def page_with(page, text):
    """The page with the text between the marks, in a section of its own at the end if there is none."""
    section = f"{BEGIN}\n{text}\n{END}"
    if BEGIN not in page:
        return f"{page.rstrip()}\n\n{HEADING}\n\n{section}\n"
    head, rest = page.split(BEGIN, 1)
    return head + section + rest.split(END, 1)[1]


def parse_options(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", type=seeds_in, default=seeds_in("1-20"), metavar="1-20,33")
    parser.add_argument("--scenario", nargs="+", default=DANGERS + HARMLESS + ORDINARY, metavar="NAME")
    parser.add_argument("--output", default="out/collision", metavar="DIR", help="runs stay here")
    parser.add_argument("--binary", default=str(ROOT / "build/release/bin/slammot"), metavar="FILE")
    parser.add_argument("--config", metavar="FILE", help="settings of `slammot warn`")
    parser.add_argument("--again", action="store_true", help="judge the runs that are in --output with new warnings, instead of running again")
    parser.add_argument("--write", action="store_true", help=f"write the table into {RESULTS_PAGE.relative_to(ROOT)}")
    parser.add_argument("--check", action="store_true", help="exit code 1 where less is warned of, or more warnings are false, than wanted")
    parser.add_argument("--known-false", type=int, default=0, metavar="N", help="with --check: false warnings whose cause is known")
    return parser.parse_args(arguments)


def main(arguments):
    options = parse_options(arguments)
    verdicts = []
    for scenario in options.scenario:
        verdict = Verdict()
        for seed in options.seeds:
            verdict.add(run(options, scenario, seed))
        verdicts.append((scenario, verdict))
    text = table(verdicts)
    print(text)
    if options.write:
        RESULTS_PAGE.write_text(page_with(RESULTS_PAGE.read_text(), text))
    everything = total(verdicts)
    is_good = (everything.warned >= WANTED_SHARE * everything.dangers and
               everything.false <= options.known_false + WANTED_PER_HOUR * everything.seconds / 3600.0)
    return 1 if options.check and not is_good else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
