"""Lines of chaos_timeline, and figures of them: silences, who leads, whether tracks keep their ids."""

import bisect
import csv
import math
import subprocess
import threading

NS = 1_000_000_000
OUTPUT = {"localization": "pose", "detection": "segments", "tracking": "tracks"}
SAME_M = 2.0  # centre of an object in two runs


class Timeline:
    """What consumers of a vehicle get, as it comes."""

    def __init__(self, options, services, vehicle="vehicle"):
        command = [options.observer.with_name("chaos_timeline"), str(services.domain), vehicle]
        self.process = subprocess.Popen(command, env=services.environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.lines = {kind: [] for kind in ["pose", "segments", "tracks", "beat"]}
        self.thread = threading.Thread(target=self._read, daemon=True)
        self.thread.start()

    def _read(self):
        for line in self.process.stdout:
            kind, *values = line.rstrip("\n").split(",")
            if kind in self.lines:  # others are of the log
                self.lines[kind].append((int(values[0]), int(values[1]), values[2:]))

    def count(self, kind):
        return len(self.lines[kind])

    def between(self, kind, from_ns, to_ns):
        """Lines received in this time."""
        lines = list(self.lines[kind])
        received = [line[0] for line in lines]
        return lines[bisect.bisect_left(received, from_ns):bisect.bisect_right(received, to_ns)]

    def longest_silence_ms(self, kind, from_ns, to_ns):
        """Between two samples that were received in this time; up to its end after the last one."""
        received = [line[0] for line in self.between(kind, from_ns, to_ns)] + [to_ns]
        return max((b - a for a, b in zip([from_ns] + received, received)), default=0) * 1e-6

    def stands_by(self, service, process):
        """True if its newest heartbeat says so."""
        beats = [rest for _, _, rest in list(self.lines["beat"]) if rest[0] == service and int(rest[1]) == process]
        return bool(beats) and beats[-1][2] == "1"

    def leads(self, service, process):
        beats = [rest for _, _, rest in list(self.lines["beat"]) if rest[0] == service and int(rest[1]) == process]
        return bool(beats) and beats[-1][2] == "0" and beats[-1][3] != "0"

    def overlapping_leaders(self, service):
        """Pairs of processes that led at the same time by their heartbeats: from the first as leader to the last. In a long run the number of a
        process comes again, in another term."""
        spans = {}
        for received_ns, _, (name, process, stands_by, term) in list(self.lines["beat"]):
            if name == service and stands_by == "0" and term != "0":
                first_ns, _ = spans.get((process, term), (received_ns, received_ns))
                spans[process, term] = (first_ns, received_ns)
        ordered = sorted(spans.values())
        return sum(later[0] < earlier[1] for earlier, later in zip(ordered, ordered[1:]))

    def tracks(self):
        """As read_tracks()."""
        return {stamp_ns // 1000: {int(track): (float(x), float(y)) for track, x, y in (one.split(":") for one in rest)}
                for _, stamp_ns, rest in list(self.lines["tracks"])}

    def poses(self):
        """By stamp [us]: x, y, heading, map id."""
        return {stamp_ns // 1000: (float(x), float(y), float(heading), int(map_id))
                for _, stamp_ns, (x, y, heading, map_id) in list(self.lines["pose"])}

    def end(self):
        self.process.terminate()
        self.process.wait()
        self.thread.join()


def read_tracks(path):
    """tracks.csv: by stamp [us] the position of each track in map."""
    tracks = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            tracks.setdefault(round(float(row["timestamp"]) * 1e6), {})[int(row["track_id"])] = (float(row["x"]), float(row["y"]))
    return tracks


def read_poses(path):
    """online_covariance.csv: by stamp [us] the pose in odom."""
    with open(path, newline="", encoding="utf-8") as file:
        return {round(float(row["timestamp"]) * 1e6): (float(row["x"]), float(row["y"])) for row in csv.DictReader(file)}


def at(tracks, stamps, stamp_us):
    """The newest that is not newer, and not older than 0.1 s."""
    index = bisect.bisect_right(stamps, stamp_us) - 1
    return tracks[stamps[index]] if index >= 0 and stamp_us - stamps[index] <= 100_000 else {}


def nearest(position, tracks):
    """Id of the nearest track; None where none is near."""
    near = min(tracks.items(), key=lambda one: math.dist(position, one[1]), default=None)
    return near[0] if near and math.dist(position, near[1]) <= SAME_M else None


def ids_kept(undisturbed, disturbed, disturbances_us, before_us=50_000, after_us=1_500_000):
    """(kept, all) ids of objects that an undisturbed run tracks under one id from before each disturbance until after it, and the disturbed run
    tracked before. All stamps by the data's clock."""
    stamps, other_stamps = sorted(undisturbed), sorted(disturbed)
    kept, total = 0, 0
    for disturbance_us in disturbances_us:
        first, second = disturbance_us - before_us, disturbance_us + after_us
        was, becomes = at(undisturbed, stamps, first), at(undisturbed, stamps, second)
        other_was, other_becomes = at(disturbed, other_stamps, first), at(disturbed, other_stamps, second)
        for track in was.keys() & becomes.keys():
            before = nearest(was[track], other_was)
            if before is None:
                continue
            total += 1
            kept += before == nearest(becomes[track], other_becomes)
    return kept, total


def farthest_m(poses, reference, from_us, to_us):
    """Largest distance between poses of the same stamp."""
    return max((math.dist(pose[:2], reference[stamp]) for stamp, pose in poses.items() if from_us <= stamp <= to_us and stamp in reference),
               default=float("nan"))
