"""Tables, picture and verdict of tests/estimators/compare, with programs that make the figures up."""

import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
LOADER = importlib.machinery.SourceFileLoader("compare", str(HERE / "compare"))
compare = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare", LOADER))
LOADER.exec_module(compare)

SIZES = """| submaps | closures | ATE (m), graph / ekf | NEES, graph / ekf | one closure (ms), graph / ekf | one withdrawal (ms), graph / ekf |
|---|---|---|---|---|---|
| 21 | 1 | 1.4 / 1.5 | 2.8 / 2.9 | 0.020 / 0.000 | 0.02 / 0.01 |
| 100 | 17 | 2.6 / 2.7 | 3.0 / 3.1 | 0.600 / 0.300 | 0.8 / 1.5 |
"""
SLAMMOT = """#!/usr/bin/env python3
import json, pathlib, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "run":
    folder = pathlib.Path(words["--output"])
    is_ekf = "ekf" in pathlib.Path(words["--config"]).read_text()
    (folder / "report.json").write_text(json.dumps({"counts": {"loop_constraints": 4 + is_ekf, "submaps": 9},
        "counters": {"loop_closing": {"withdrawn": 1}}, "measured": {"stage_latency": {"loop_closing": {"max_ms": 7.0}}}}))
else:
    folder = pathlib.Path(words["--result"])
    error = FACTOR if folder.name.endswith("ekf") else 1.0
    (folder / "evaluation.json").write_text(json.dumps({"trajectory": {"ate_m": {"rmse": error}}}))
"""


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def drives(self, factor):
        program = self.folder / "slammot"
        program.write_text(SLAMMOT.replace("FACTOR", str(factor)))
        program.chmod(0o755)
        return subprocess.run([sys.executable, HERE / "compare", "--only", "drives", "--binary", program, "--estimators", program,
                               "--output", self.folder / "out", "--scenario", "city", "--input"], capture_output=True, text=True)

    def test_has_both_estimators_in_a_row(self):
        done = self.drives(1.05)
        self.assertIn("| `city` 3001 | 9 | 4 / 5 | 1 / 1 | 1.000 / 1.050 | 7 / 7 |", done.stdout)
        self.assertEqual(0, done.returncode, done.stderr)

    def test_fails_where_the_filter_is_more_than_a_tenth_worse(self):
        self.assertEqual(1, self.drives(1.2).returncode)

    def test_draws_both_curves_of_each_panel(self):
        lines = xml.dom.minidom.parseString(compare.picture(SIZES)).getElementsByTagName("polyline")
        points = [line.getAttribute("points").split() for line in lines]
        self.assertEqual([2, 2, 2, 2, 2, 1, 2, 2], [len(one) for one in points])  # no logarithm of a cost of 0
        self.assertLess(float(points[1][0].split(",")[1]), float(points[0][0].split(",")[1]))  # 1.5 is above 1.4

    def test_replaces_its_half_of_the_page_only(self):
        begin, end = compare.MARKS["drives"]
        page = compare.inserted(f"before\n{begin}old\n{end}after\n", "drives", "new\n")
        self.assertEqual(f"before\n{begin}new\n{end}after\n", page)
        self.assertEqual(page, compare.inserted(page, "graphs", "other\n"))


if __name__ == "__main__":
    unittest.main()
