#!/usr/bin/env python3
"""Each example takes the place of its service, in the pipeline and over DDS, and both give the same result.

usage: examples_test.py SLAMMOT
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent.parent / name) for name in ("compose", "bench")]
from bench_test import children_of, wait_until  # noqa: E402
from trajectory import aligned_rmse_m, read_tum  # noqa: E402

PATIENCE = float(os.environ.get("SLAMMOT_TEST_PATIENCE", 1))  # more for services built with sanitizers
UNCHANGED = {"slammot-ingest", "slammot-detection", "slammot-loop-closing", "slammot-map-store"}


class Examples(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-examples-test-")
        cls.work = pathlib.Path(cls.folder.name)
        subprocess.run([cls.slammot, "simulate", "block", "--output", cls.work], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def settings(self, name, **implementations):
        file = self.work / f"{name}.textproto"
        file.write_text("implementations { " + " ".join(f'{stage}: "{one}"' for stage, one in implementations.items()) + " }\n")
        return file

    def command(self, command, settings, name):
        return [self.slammot, command, "--input", self.work / "block.log", "--config", settings, "--output", self.work / name]

    def run_in_one_process(self, settings, name):
        subprocess.run(self.command("run", settings, name), check=True, stdout=subprocess.DEVNULL)

    def bench(self, settings, name, during=lambda process: None):
        """Names of the programs that ran."""
        process = subprocess.Popen(self.command("bench", settings, name), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            programs = wait_until(lambda: len(children_of(process.pid)) == 6 and set(children_of(process.pid).values()), "six services")
            during(process)
            words, _ = process.communicate(timeout=120 * PATIENCE)
        finally:
            process.kill()
        self.assertEqual(process.returncode, 0, words)
        return programs

    def ate_m(self, name):
        return aligned_rmse_m(read_tum(self.work / name / "trajectory.tum"), read_tum(self.work / "block.tum"))

    def confirmed_tracks(self, name):
        with open(self.work / name / "tracks.csv", newline="") as file:
            return len({row["track_id"] for row in csv.DictReader(file)})

    def counters(self, name):
        return json.loads((self.work / name / "report.json").read_text())["counters"]

    def rows(self, name):
        return len((self.work / name / "online.tum").read_text().splitlines())

    def compare(self, name, programs, most_ate_m, **implementations):
        settings = self.settings(name, **implementations)
        self.run_in_one_process(settings, f"{name}-run")
        self.assertEqual(self.bench(settings, f"{name}-bench"), UNCHANGED | programs)
        self.assertLess(self.ate_m(f"{name}-run"), most_ate_m)
        self.assertLess(abs(self.ate_m(f"{name}-bench") - self.ate_m(f"{name}-run")), 0.05)
        tracks = self.confirmed_tracks(f"{name}-run")
        self.assertGreater(tracks, 10)
        self.assertLessEqual(abs(self.confirmed_tracks(f"{name}-bench") - tracks), 0.1 * tracks)
        self.assertEqual(self.rows(f"{name}-bench"), self.rows(f"{name}-run"))

    def test_greedy_tracker_takes_the_place_of_tracking(self):
        self.compare("greedy", {"slammot-localization", "slammot-greedy-tracker"}, 0.2, tracking="greedy")
        self.assertNotIn("tracks_merged", self.counters("greedy-run")["tracking"])

    def test_icp_localizer_takes_the_place_of_localization(self):
        self.compare("icp", {"slammot-icp-localizer", "slammot-tracking"}, 1.0, localization="icp")
        self.assertIn("unmatched_scans", self.counters("icp-run")["localization"])

    def test_both_together_make_the_same_bytes_every_time(self):
        settings = self.settings("both", localization="icp", tracking="greedy")
        for name in ("first", "second"):
            self.run_in_one_process(settings, name)
        for file in ("trajectory.tum", "tracks.csv", "map.pgm", "graph.g2o"):
            self.assertEqual((self.work / "first" / file).read_bytes(), (self.work / "second" / file).read_bytes(), file)

    def test_greedy_tracker_may_be_killed(self):
        def kill(process):
            victim = next(number for number, name in children_of(process.pid).items() if name == "slammot-greedy-tracker")
            subprocess.run(["kill", "-9", str(victim)], check=True)
            wait_until(lambda: any(name == "slammot-greedy-tracker" and number != victim for number, name in children_of(process.pid).items()), "a new one")

        settings = self.settings("killed", tracking="greedy")
        self.bench(settings, "killed", kill)
        self.assertEqual(self.counters("killed")["bench"]["restarts_of_tracking"], 1)
        self.assertGreater(self.confirmed_tracks("killed"), 10)


if __name__ == "__main__":
    Examples.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
