#!/usr/bin/env python3
"""A car among trees whose wheels count turns 6 % too large or too small: few echoes tell the heading, two laps close the loop.

usage: park_test.py SLAMMOT
"""

import json
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests/integration"), str(ROOT / "tests/tools")]

import park_drive
from program_case import ProgramCase

LARGEST_ATE_M = 1.2  # over 3 m where turns are taken for true ones and ties for those of a street; 0.2 to 0.9 in eight of nine draws


class Park(ProgramCase):
    def test_wheels_that_turn_too_much_or_too_little(self):
        for factor in (1.06, 0.94):
            with self.subTest(factor=factor):
                drive, result = self.work / f"drive-{factor}", self.work / f"result-{factor}"
                park_drive.main([str(drive), "--laps", "2", "--turn-factor", str(factor)])
                self.call("run", "--input", f"{drive}.log", "--profile", "urban", "--output", result, "--quiet", "--no-report")
                self.call("eval", "--result", result, "--truth", drive)
                evaluation = json.loads((result / "evaluation.json").read_text())
                self.assertLess(evaluation["trajectory"]["ate_m"]["rmse"], LARGEST_ATE_M)


if __name__ == "__main__":
    ProgramCase.slammot = sys.argv.pop(1)
    unittest.main()
