#!/usr/bin/env python3
"""Drives of one vehicle in one stored map: the services are stopped and started again between them, on a closed bus.

usage: stored_map_test.py SLAMMOT
"""

import csv
import hashlib
import json
import math
import os
import pathlib
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

PATIENCE = float(os.environ.get("SLAMMOT_TEST_PATIENCE", 1))  # more for services built with sanitizers
SERVICES = ["map-store", "loop-closing", "localization", "detection", "tracking"]
BUS = """<CycloneDDS><Domain Id="any"><General><Interfaces><NetworkInterface name="lo"/></Interfaces>
<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>
<Peers><Peer Address="127.0.0.1"/></Peers><Tag>stored-map-{0}</Tag></Discovery></Domain></CycloneDDS>"""

# The same streets for both (one seed), the second drive begins a block away and looks the other way.
SCENARIO = """
seed: 5
duration_s: {duration_s}
city {{ blocks_east: 3 blocks_north: 3 block_pitch_m: 75 signalled_share: 0 }}
traffic {{ cars: 6 bicycles: 2 }}
walkers {{ pedestrians: 15 }}
route {{
  junctions [{junctions}]
  start_m: {start_m}
}}
"""
DRIVES = {
    "first": {"duration_s": 60, "start_m": 30, "route": [(0, 1), (2, 1), (2, 2), (1, 2), (1, 1), (2, 1)]},
    "second": {"duration_s": 45, "start_m": 15, "route": [(2, 2), (1, 2), (1, 1), (2, 1), (2, 2)]},
}

FARTHEST_OFF_M = 0.45  # in the frame of the first pose, of which two milliradians are 0.3 m at the far end


def read_poses(path):
    """{stamp in us: (x in m, y in m, heading in rad)} of a TUM file."""
    poses = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            stamp, x, y, _, _, _, qz, qw = map(float, line.split())
            poses[round(stamp * 1e6)] = (x, y, 2.0 * math.atan2(qz, qw))
    return poses


def seen_from(origin, pose):
    """Position of a pose in the frame of another."""
    x, y = pose[0] - origin[0], pose[1] - origin[1]
    c, s = math.cos(origin[2]), math.sin(origin[2])
    return c * x + s * y, c * y - s * x


class StoredMap(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-stored-map-test-")
        cls.work = pathlib.Path(cls.folder.name)
        for sanitizer in ["TSAN_OPTIONS", "ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS"]:
            os.environ[sanitizer] = os.environ.get(sanitizer, "") + f":log_path={cls.work / 'sanitizer-report'}"
        os.environ["CYCLONEDDS_URI"] = BUS.format(os.getpid())
        for name, drive in DRIVES.items():
            junctions = ", ".join(f"{{ column: {column} row: {row} }}" for column, row in drive["route"])
            scenario = cls.work / f"{name}.textproto"
            scenario.write_text(SCENARIO.format(duration_s=drive["duration_s"], start_m=drive["start_m"], junctions=junctions))
            subprocess.run([cls.slammot, "simulate", scenario, "--output", cls.work], check=True, stdout=subprocess.DEVNULL)
        # However slow this machine is, corrections come as early in the drive as they would on a vehicle.
        (cls.work / "patient.textproto").write_text("ingest { graph_patience_s: 60 }")
        cls.truth = {name: read_poses(cls.work / f"{name}.tum") for name in DRIVES}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def setUp(self):
        self.running = {}
        self.state = self.work / self.id().rsplit(".", 1)[-1]

    def tearDown(self):
        self.stop(*self.running)
        for report in self.work.glob("sanitizer-report*"):
            self.fail(report.read_text())

    def log_of(self, service):
        return self.state.with_suffix(f".{service}.log")

    def start(self, *services):
        for service in services:
            command = [f"{self.slammot}-{service}", "--vehicle", "car", "--profile", "urban", "--state-dir", self.state]
            if service == "localization":
                command.append("--continue-map")
            with open(self.log_of(service), "a", encoding="utf-8") as log:
                self.running[service] = subprocess.Popen(command, stdout=log, stderr=log)

    def stop(self, *services):
        for service in services:
            self.running[service].terminate()
        for service in services:
            self.running.pop(service).wait(timeout=10 * PATIENCE)

    def ingest_of(self, name, speed="max"):
        return [f"{self.slammot}-ingest", "--vehicle", "car", "--profile", "urban", "--state-dir", self.state, "--input", self.work / f"{name}.log",
                "--speed", speed, "--config", self.work / "patient.textproto"]

    def drive(self, name, output):
        """Plays the drive into the services as fast as they are done, and waits for what they make of it."""
        log = self.work / f"{name}.log"
        collector = subprocess.Popen([self.slammot, "collect", "--vehicle", "car", "--input", log, "--output", self.work / output],
                                     stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        ingest = subprocess.run(self.ingest_of(name), capture_output=True, text=True, timeout=100 * PATIENCE, check=False)
        self.assertEqual(ingest.returncode, 0, ingest.stdout + ingest.stderr)
        words, _ = collector.communicate(timeout=100 * PATIENCE)
        self.assertEqual(collector.returncode, 0, words)

    def counters(self, output, service):
        return json.loads((self.work / output / "report.json").read_text())["counters"][service]

    def confirmed_tracks(self, output):
        with open(self.work / output / "tracks.csv", newline="", encoding="utf-8") as file:
            return len({row["track_id"] for row in csv.DictReader(file)})

    def wait_until(self, condition, what):
        end = time.monotonic() + 30 * PATIENCE
        while not condition():
            self.assertLess(time.monotonic(), end, f"waited in vain for {what}")
            time.sleep(0.02)

    def checkpoint_time(self):
        return (self.state / "localization-car.checkpoint").stat().st_mtime_ns

    def stored_submaps(self):
        """{(map, number): hash} of what is in the database."""
        try:
            with sqlite3.connect(f"file:{self.state / 'map.sqlite'}?mode=ro", uri=True) as database:
                rows = database.execute("SELECT map_id, submap_id, record FROM submap WHERE vehicle_id = 'car'").fetchall()
        except sqlite3.OperationalError:  # not made yet
            return {}
        return {(map_id, submap_id): hashlib.sha256(record).hexdigest() for map_id, submap_id, record in rows}

    def assert_one_whole_map(self, submaps):
        self.assertEqual(len({map_id for map_id, _ in submaps}), 1)
        self.assertEqual(sorted(number for _, number in submaps), list(range(len(submaps))), "a submap is missing")

    def errors_m(self, name, output, file):
        """Of each pose against the truth, in the map's frame: that in which the first drive began."""
        world_from_map = self.truth["first"][min(self.truth["first"])]
        poses = read_poses(self.work / output / file)
        self.assertEqual(len(poses), len(self.truth[name]))
        true = {stamp: seen_from(world_from_map, pose) for stamp, pose in self.truth[name].items()}
        return [math.dist(poses[stamp][:2], true[stamp]) for stamp in sorted(poses)]

    def assert_localized_in_the_map(self, name, output):
        self.assertLess(max(self.errors_m(name, output, "trajectory.tum")), FARTHEST_OFF_M)
        online_m = self.errors_m(name, output, "online.tum")
        self.assertGreater(online_m[0], 5.0, "it began at a place that nobody had told it")
        self.assertLess(max(online_m[len(online_m) // 2:]), FARTHEST_OFF_M, "and had found it before half of the drive was over")

    def test_drives_go_on_in_the_map_of_those_before(self):
        self.start(*SERVICES)
        self.drive("first", "first")
        self.assertLess(max(self.errors_m("first", "first", "trajectory.tum")), FARTHEST_OFF_M)
        of_first = self.stored_submaps()
        self.assert_one_whole_map(of_first)
        self.stop(*SERVICES)

        self.start(*SERVICES)
        self.drive("second", "second")
        self.assertEqual(self.counters("second", "localization")["continued_maps"], 1)
        self.assert_localized_in_the_map("second", "second")
        of_both = self.stored_submaps()
        self.assert_one_whole_map(of_both)
        self.assertEqual(of_first, {key: of_both.get(key) for key in of_first}, "a submap of the first drive has changed")

        # The same log again, with every service still running: stamps go back, and the map is the same.
        self.drive("second", "again")
        self.assertEqual(self.counters("again", "localization")["continued_maps"], 2)
        self.assert_localized_in_the_map("second", "again")
        self.assert_one_whole_map(self.stored_submaps())
        tracks = self.confirmed_tracks("second")
        self.assertLessEqual(abs(self.confirmed_tracks("again") - tracks), max(1, 0.1 * tracks))
        self.assertEqual(self.counters("again", "tracking").get("repeated_scans", 0), self.counters("second", "tracking").get("repeated_scans", 0))

    def test_a_drive_goes_on_in_the_map_of_one_that_was_killed(self):
        self.start(*SERVICES)
        # Slow enough that several checkpoints are written, a second apart, between the fifth submap and the end.
        ingest = subprocess.Popen(self.ingest_of("first", speed="4"), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait_until(lambda: len(self.stored_submaps()) >= 5, "five submaps")
        for _ in range(2):  # the second checkpoint from now on is of a later submap for sure
            before = self.checkpoint_time()
            self.wait_until(lambda then=before: self.checkpoint_time() != then, "a checkpoint")
        for process in [ingest, *self.running.values()]:
            process.kill()
        ingest.wait()
        self.stop(*self.running)
        of_first = self.stored_submaps()
        self.assertGreaterEqual(len(of_first), 5)

        self.start(*SERVICES)
        self.drive("second", "after_kill")
        self.assert_localized_in_the_map("second", "after_kill")
        of_both = self.stored_submaps()
        self.assert_one_whole_map(of_both)
        self.assertEqual(of_first, {key: of_both.get(key) for key in of_first}, "a submap of the first drive has changed")
        self.assertIn("hands over submap", self.log_of("localization").read_text(encoding="utf-8"))


if __name__ == "__main__":
    StoredMap.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
