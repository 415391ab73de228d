#!/usr/bin/env python3
"""One pair of drives through one town is joined right, one pair through two towns is refused, and the next drive continues in the joint map.

usage: merge_test.py SLAMMOT
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import merging

FARTHEST_OFF_M = 1.0
LEAST_SHARE_OF_LANES = 0.9  # lines that meet in the joint map shift by decimetres


class MapMerge(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-merge-test-")
        cls.work = pathlib.Path(cls.folder.name)
        cls.first = merging.drive(cls.slammot, "first", 1, cls.work)
        cls.second = merging.drive(cls.slammot, "second", 1, cls.work)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_joins_two_drives_through_one_town(self):
        joint = self.work / "joint"
        merged = merging.merge(self.slammot, self.first, self.second, joint)
        self.assertTrue(merged.is_joined, merged.text)
        self.assertGreaterEqual(merged.counters["places"], 3)
        self.assertEqual(merged.counters["contradicting"], 0)
        self.assertLess(max(merged.first_m), FARTHEST_OFF_M)
        self.assertLess(max(merged.second_m), FARTHEST_OFF_M)
        for name in ["map.png", "map.pgm", "map.yaml", "moving.png", "graph.g2o", "report.json", "settings.textproto"]:
            self.assertGreater((joint / name).stat().st_size, 0, name)
        again = merging.merge(self.slammot, self.first, self.second, self.work / "again")
        self.assertTrue(again.is_joined)
        self.assertEqual((joint / "graph.g2o").read_bytes(), (self.work / "again" / "graph.g2o").read_bytes())

        output = self.work / "continued"
        run = subprocess.run([self.slammot, "run", "--input", self.second / "truth.log.gz", "--map", joint, "--output", output], check=True,
                             stdout=subprocess.PIPE, text=True)
        self.assertIn("the drive is located in the map", run.stdout)
        closures = json.loads((output / "report.json").read_text())["counters"]["loop_closing"]
        self.assertEqual(closures["found_elsewhere"], 1, "the joint map is one, and the drive was found in it")

    def test_has_the_lanes_of_both_drives(self):
        joint = self.work / "with-lanes"
        merging.merge(self.slammot, self.first, self.second, joint)
        lanes = merging.points_of_ways(joint)
        self.assertGreater(merging.share_found(merging.points_of_ways(self.first), lanes), LEAST_SHARE_OF_LANES)
        nodes, join = merging.nodes_of(joint / "graph.g2o"), len(merging.first_stamps_of(self.first))
        beginning = merging.nodes_of(self.second / "graph.g2o")[0]
        of_second = [merging.placed(nodes[join], merging.seen_from(beginning, (*point, 0.0))) for point in merging.points_of_ways(self.second)]
        self.assertGreater(merging.share_found(of_second, lanes), LEAST_SHARE_OF_LANES)
        self.assertLess(merging.share_found(of_second, merging.points_of_ways(self.first)), 0.8, "the first drive has seen them, too")

    def test_refuses_drives_through_two_towns(self):
        other = merging.drive(self.slammot, "second", 2, self.work)
        output = self.work / "refused"
        merged = merging.merge(self.slammot, self.first, other, output)
        self.assertFalse(merged.is_joined, merged.text)
        self.assertIn("not merged", merged.text)
        self.assertFalse(output.exists())

    def test_names_a_map_that_is_missing(self):
        refused = subprocess.run([self.slammot, "map", "merge", self.first, self.work / "nowhere", "--output", self.work / "none"], check=False,
                                 stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("nowhere", refused.stderr)
        self.assertEqual(len(refused.stderr.splitlines()), 1)


if __name__ == "__main__":
    MapMerge.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
