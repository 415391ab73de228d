#!/usr/bin/env python3
"""Replayed on a recording of itself each service publishes what was recorded; with one changed setting the difference is named, with its
scan and field.

Usage: process_replay_test.py SLAMMOT"""

import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

from recorded_drive import record_drive

PATIENCE_S = 240
SERVICES = {"detection": "segmented_scan", "tracking": "scan_labels", "localization": "localized_scan",
            "loop_closing": "graph_correction", "map_store": "stored_submap_tile"}


class ProcessReplay(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-process-replay-")
        cls.work = pathlib.Path(cls.folder.name)
        cls.recording = record_drive(SLAMMOT, cls.work)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def replay(self, service, *arguments, recording=None):
        begin = time.monotonic()
        done = subprocess.run([SLAMMOT, "replay", recording or self.recording, "--service", service, *arguments], capture_output=True,
                              text=True, check=False, timeout=PATIENCE_S)
        print(f"{service} {' '.join(arguments)}: exit code {done.returncode}, {time.monotonic() - begin:.1f} s\n{done.stdout}{done.stderr}")
        return done

    def with_setting(self, text):
        path = self.work / "changed.textproto"
        path.write_text(text)
        return ["--config", str(path)]

    def test_an_unchanged_build_makes_no_difference(self):
        for service, topic in SERVICES.items():
            with self.subTest(service):
                done = self.replay(service)
                self.assertEqual(0, done.returncode)
                self.assertIn("no difference", done.stdout)
                compared = int(re.search(rf"slammot/{topic}: (\d+) samples compared, 0 differ", done.stdout).group(1))
                self.assertGreater(compared, 0)

    def first_difference(self, done):
        """(topic, stamp in s, field)"""
        self.assertEqual(1, done.returncode)
        found = re.search(r"first difference: (\S+), stamp (\d+) ns, [\d.]+ s into the recording, ([^:]+): \S+ was recorded, \S+ now", done.stdout)
        self.assertIsNotNone(found, done.stdout)
        return found.group(1), int(found.group(2)) * 1e-9, found.group(3)

    def test_a_changed_setting_is_named_at_the_first_scan_that_it_changes(self):
        first_scan = float((self.work / "result" / "online.tum").read_text().split()[0])
        cases = [("detection", "detection { range_noise_m: 0.06 }", "slammot/segmented_scan", "centroid_covariance_m2", 0.0),
                 ("localization", "localization { range_noise_m: 0.05 }", "slammot/localized_scan", "odom_from_base", 0.1),
                 ("tracking", "tracking { shape_noise_m: 0.4 }", "slammot/tracked_objects", "objects[0]", 3.0)]  # of the first box
        for service, settings, topic, field, latest in cases:
            with self.subTest(service):
                found, stamp, path = self.first_difference(self.replay(service, *self.with_setting(settings)))
                self.assertEqual(topic, found)
                self.assertIn(field, path)
                self.assertAlmostEqual(first_scan, stamp, delta=latest + 1e-6)

    def test_what_cannot_be_replayed_is_told_in_one_line(self):
        broken = self.work / "broken.mcap"
        broken.write_bytes(b"no recording")
        for arguments, words in [(["--service", "gateway"], "--service is one of detection"), (["--service", "tracking"], "broken.mcap")]:
            done = subprocess.run([SLAMMOT, "replay", broken, *arguments], capture_output=True, text=True, check=False)
            self.assertEqual((2, 1), (done.returncode, len(done.stderr.splitlines())), done.stderr)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    SLAMMOT = sys.argv.pop(1)
    unittest.main(verbosity=2)
