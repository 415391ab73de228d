#!/usr/bin/env python3
"""Takes a drive with a vertical scanner through run, model and plot, and judges the model by the truth.

usage: city_model_test.py SLAMMOT
"""

import gzip
import json
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from program_case import ProgramCase

STREET = pathlib.Path(__file__).with_name("street.textproto")
SCANS = 14 * 37  # Of the planar scanner, at least.


class CityModel(ProgramCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.result = cls.work / "result"
        cls.told = cls.call("run", "--scenario", STREET, "--profile", "urban", "--output", cls.result, "--no-report").stdout
        cls.model = cls.call("model", "--result", cls.result, "--truth", cls.result / "truth", "--points", cls.work / "points.ply").stdout

    def figures(self):
        return json.loads((self.result / "model.json").read_text())

    def test_facades_are_where_the_walls_are_and_as_high(self):
        accuracy = self.figures()["accuracy"]
        self.assertLess(accuracy["point_distance_median_m"], 0.06)
        self.assertLess(accuracy["point_distance_p95_m"], 0.3)
        self.assertGreater(accuracy["wall_facades"], 200)
        self.assertLess(accuracy["wall_top_error_median_m"], 0.3)

    def test_moving_objects_and_the_road_are_left_out(self):
        figures = self.figures()
        self.assertLess(figures["accuracy"]["residue_share"], 0.01)
        self.assertGreater(figures["of_movers"] + figures["in_free_space"], 500)
        self.assertGreater(figures["of_road"], 10000)
        self.assertLessEqual(figures["scans_without_pose"], 2)

    def test_writes_facades_and_points_as_binary_ply(self):
        figures = self.figures()
        for file, faces in [(self.result / "model.ply", figures["facades"]), (self.work / "points.ply", 0)]:
            header, rest = file.read_bytes().split(b"end_header\n", 1)
            self.assertTrue(header.startswith(b"ply\nformat binary_little_endian 1.0\nelement vertex "))
            vertices = 4 * faces or figures["points"]
            self.assertIn(b"element vertex %d\n" % vertices, header)
            self.assertEqual(len(rest), 15 * vertices + 17 * faces)

    def test_is_drawn(self):
        self.call("plot", "model", self.result, "--size", 600)
        self.assertTrue((self.result / "model_plot.png").read_bytes().startswith(b"\x89PNG"))

    def test_vertical_scans_reach_neither_localization_nor_tracking(self):
        self.assertIn("vertical: ROBOTLASER2", self.told)
        self.assertLess(len((self.result / "online.tum").read_text().splitlines()), SCANS + 38)
        lines = gzip.decompress((self.result / "truth.log.gz").read_bytes()).decode().splitlines(keepends=True)
        planar = self.work / "planar.log"
        planar.write_text("".join(line for line in lines if not line.startswith(("ROBOTLASER2", "PARAM robot_laser2"))))
        self.call("run", "--input", planar, "--profile", "urban", "--output", self.work / "planar", "--no-report")
        self.call("run", "--input", self.result / "truth.log.gz", "--profile", "urban", "--output", self.work / "both", "--no-report")
        for name in ["trajectory.tum", "online.tum", "tracks.csv", "map.pgm", "graph.g2o"]:
            self.assertEqual((self.work / "planar" / name).read_bytes(), (self.work / "both" / name).read_bytes(), name)

    def test_a_log_that_does_not_state_the_mounting_is_refused_until_it_is_given(self):
        lines = gzip.decompress((self.result / "truth.log.gz").read_bytes()).decode().splitlines(keepends=True)
        untold = self.work / "untold.log"
        untold.write_text("".join(line for line in lines if not ("robot_laser2" in line and ("roll" in line or "pitch" in line))))
        refused = self.call("model", "--result", self.result, "--input", untold, code=1).stderr
        self.assertIn("no scanner of vertical profiles by the log (its scanners: ROBOTLASER1, ROBOTLASER2)", refused)
        output = self.work / "given.ply"
        self.call("model", "--result", self.result, "--input", untold, "--output", output, "--vertical", "ROBOTLASER2=1,0,2,0,-90,0")
        given = json.loads(output.with_suffix(".json").read_text())
        self.assertAlmostEqual(given["points"] / self.figures()["points"], 1.0, delta=0.001)  # the log rounds angles

    def test_the_readable_part_of_a_log_that_is_cut_is_used_and_said(self):
        whole = (self.result / "truth.log.gz").read_bytes()
        cut = self.work / "cut.log.gz"
        cut.write_bytes(whole[:len(whole) // 2])
        output = self.work / "cut.ply"
        stderr = self.call("model", "--result", self.result, "--input", cut, "--output", output, code=3).stderr
        self.assertIn("cut.log.gz is cut off or damaged: only the readable part was processed", stderr)
        self.assertEqual(stderr.count("\n"), 1)
        self.assertTrue(0 < json.loads(output.with_suffix(".json").read_text())["points"] < self.figures()["points"])

    def test_the_log_of_another_drive_is_refused(self):
        def later(line):
            fields = line.rstrip("\n").split(" ")
            if fields[0].startswith("ROBOTLASER"):  # stamps of the scanner and of the logger, at the end
                fields[-3], fields[-1] = (f"{float(fields[i]) + 0.0071:.6f}" for i in (-3, -1))
            return " ".join(fields) + "\n"

        lines = gzip.decompress((self.result / "truth.log.gz").read_bytes()).decode().splitlines(keepends=True)
        other = self.work / "later.log"
        other.write_text("".join(later(line) for line in lines))
        stderr = self.call("model", "--result", self.result, "--input", other, code=1).stderr
        self.assertIn("planar scans are at the time of a pose of the result: not the log of that run", stderr)

    def test_wrong_input_is_told_in_one_line(self):
        other = self.work / "other.log"
        other.write_text("FLASER 3 1.0 2.0 3.0 0 0 0 0 0 0 5.0 host 5.0\n" * 3)
        for arguments, told in [(["--input", other], "no scanner of vertical profiles"),
                                (["--input", self.work / "none.log"], "no such log"),
                                (["--scanner", "ROBOTLASER1"], "no scanner ROBOTLASER1: there are ROBOTLASER2")]:
            stderr = self.call("model", "--result", self.result, *arguments, code=1).stderr
            self.assertIn(told, stderr)
            self.assertEqual(stderr.count("\n"), 1)


if __name__ == "__main__":
    CityModel.slammot = sys.argv.pop(1)
    unittest.main()
