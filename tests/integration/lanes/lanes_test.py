#!/usr/bin/env python3
"""Takes a drive through run, plot and eval: lanes.geojson holds lanes where vehicles truly drove, and walkways where people truly walked.

usage: lanes_test.py SLAMMOT
"""

import json
import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from program_case import ProgramCase

KINDS = {"lane", "cycle_lane", "walkway"}


class Lanes(ProgramCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.result = cls.work / "result"
        cls.call("run", "--scenario", "block", "--output", cls.result, "--no-report", "--quiet")
        cls.file = json.loads((cls.result / "lanes.geojson").read_text())

    def test_is_a_collection_of_lines_in_metres_of_the_map(self):
        self.assertEqual((self.file["type"], self.file["frame"], self.file["unit"]), ("FeatureCollection", "map", "m"))
        self.assertGreater(len(self.file["features"]), 10)
        for feature in self.file["features"]:
            properties, line = feature["properties"], feature["geometry"]
            self.assertEqual(set(properties), {"kind", "line", "speed", "speed_spread", "width", "tracks", "confidence"})
            self.assertIn(properties["kind"], KINDS)
            self.assertEqual(line["type"], "LineString")
            self.assertGreaterEqual(len(line["coordinates"]), 2)
            self.assertTrue(0.0 < properties["confidence"] < 1.0)
            self.assertGreaterEqual(properties["speed"], 0.5)

    def test_lanes_are_faster_and_wider_than_walkways(self):
        mean = lambda kind, name: sum(values := [f["properties"][name] for f in self.file["features"] if f["properties"]["kind"] == kind]) / len(values)
        for name in ("speed", "width"):
            self.assertGreater(mean("lane", name), mean("walkway", name))

    def test_neighbouring_points_are_near(self):
        for feature in self.file["features"]:
            points = feature["geometry"]["coordinates"]
            self.assertLess(max(math.dist(a, b) for a, b in zip(points, points[1:])), 3.0)

    def test_true_movers_took_them(self):
        self.call("eval", "--result", self.result, "--truth", self.result / "truth")
        ways = json.loads((self.result / "evaluation.json").read_text())["ways"]["all"]
        self.assertGreater(ways["lane"]["recall"], 0.5)
        self.assertGreater(ways["lane"]["precision"], 0.7)
        self.assertGreater(ways["walkway"]["precision"], 0.5)

    def test_are_drawn(self):
        self.call("plot", "lanes", self.result, "--size", 400)
        self.assertTrue((self.result / "lanes_plot.png").read_bytes().startswith(b"\x89PNG"))
        self.call("plot", "lanes", self.result, "--size", 400, "--output", self.result / "lanes.svg")
        self.assertIn("<svg", (self.result / "lanes.svg").read_text())

    def test_a_damaged_file_is_told_in_one_line(self):
        copy = self.work / "damaged"
        copy.mkdir()
        for name in ("online.tum", "trajectory.tum"):
            (copy / name).write_bytes((self.result / name).read_bytes())
        self.assertIn("lanes.geojson: cannot be read", self.call("plot", "lanes", copy, code=1).stderr)
        (copy / "lanes.geojson").write_text((self.result / "lanes.geojson").read_text()[:500])
        stderr = self.call("plot", "lanes", copy, code=1).stderr
        self.assertIn("lanes.geojson: not a GeoJSON collection of features", stderr)
        self.assertEqual(stderr.count("\n"), 1)


if __name__ == "__main__":
    Lanes.slammot = sys.argv.pop(1)
    unittest.main()
