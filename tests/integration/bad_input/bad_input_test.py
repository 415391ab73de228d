#!/usr/bin/env python3
"""Takes a drive whose log is spoiled in every way of faults.py through one process and through the services over DDS, and
looks at what they count and at where they think they are.

usage: bad_input_test.py SLAMMOT
"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import faults

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "compose"))
from trajectory import aligned_rmse_m, read_tum  # noqa: E402

PATIENCE = float(os.environ.get("SLAMMOT_TEST_PATIENCE", 1))  # more for services built with sanitizers


def spoil(scans):
    """What must be counted, by counter of localization. Last faults first, so that places stay what they are."""
    faults.stamp(scans, 2850, 4000.0)
    faults.blind(scans, 2700, 40)                        # every beam at maximum range, for a second
    faults.jump(scans, 2400, 1.0, -0.5, 0.3)             # less than a car may go in a step, 20 degrees round
    faults.jump(scans, 2100, 400.0, -30.0, 0.0)
    faults.blind(scans, 1800, 20, kept=(40, 180, 300))   # three valid beams
    faults.leave_out(scans, 1500, 2.1)
    faults.repeat(scans, 1200, 4)
    faults.swap(scans, 900, 4)                           # the newest of four comes first
    faults.swap(scans, 600, 2)
    faults.stamp(scans, 0, 5000.0)
    return {"blank_scans": 60, "odometry_jumps": 2, "gaps": 1, "duplicate_scans": 4, "out_of_order_scans": 4, "far_ahead_scans": 2}


class BadInput(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-bad-input-test-")
        cls.work = pathlib.Path(cls.folder.name)
        subprocess.run([cls.slammot, "simulate", "block", "--output", cls.work], check=True, stdout=subprocess.DEVNULL)
        head, scans = faults.read(cls.work / "block.log")
        cls.expected = spoil(scans)
        faults.write(cls.work / "spoiled.log", head, scans)
        cls.scans = len(scans)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def take_through(self, command):
        words = [self.slammot, command, "--input", self.work / "spoiled.log", "--output", self.work / command]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=150 * PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout)
        return json.loads((self.work / command / "report.json").read_text())["counters"]

    def look_at_poses(self, command):
        poses = read_tum(self.work / command / "trajectory.tum")
        self.assertEqual(len(poses), self.scans)
        self.assertLess(aligned_rmse_m(poses, read_tum(self.work / "block.tum")), 0.05)

    def test_one_process_counts_every_fault_and_stays_where_it_is(self):
        counted = self.take_through("run")["localization"]
        self.assertEqual({name: counted[name] for name in self.expected}, self.expected)
        self.look_at_poses("run")

    def test_services_live_on_and_count_every_fault(self):
        counters = self.take_through("bench")
        counted = dict(counters["localization"])
        self.assertEqual(counters["bench"], {name: 0 for name in counters["bench"]})  # nobody had to be started again
        # What is not newer than what the others have done with is not sent at all.
        stale = self.expected["duplicate_scans"] + self.expected["out_of_order_scans"]
        self.assertEqual(counters["ingest"]["skipped_scans"] + counted["duplicate_scans"] + counted["out_of_order_scans"], stale)
        for name in ("blank_scans", "odometry_jumps", "gaps"):
            self.assertEqual(counted[name], self.expected[name], name)
        self.assertGreaterEqual(counted["far_ahead_scans"], self.expected["far_ahead_scans"])  # sent again in vain
        self.look_at_poses("bench")


if __name__ == "__main__":
    BadInput.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
