"""The table of lanes and walkways: sums over runs, and its place in a page."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import lanes_table
from table_case import TableCase

PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "run":
    if words["--scenario"] == "broken":
        sys.exit("no such scenario")
    (pathlib.Path(words["--output"]) / "seed").write_text(words["--seed"])
else:
    folder = pathlib.Path(words["--result"])
    seed = int((folder / "seed").read_text())
    lengths = lambda travelled, found, length, true: {"travelled_in_view_m": travelled, "found_m": found, "length_m": length, "true_m": true}
    kinds = {"lane": lengths(100.0 * seed, 50.0, 40.0, 30.0), "cycle_lane": lengths(0.0, 0.0, 10.0, 0.0), "walkway": lengths(10.0, 5.0, 8.0, 8.0)}
    (folder / "evaluation.json").write_text(json.dumps({"ways": {"all": kinds, "confident": kinds}}))
"""


class LanesTable(TableCase):
    command = lanes_table
    stand_in = PROGRAM

    def test_adds_lengths_before_it_divides(self):
        code, text, _ = self.printed("--scenario", "crowd", "--seeds", "1,3")
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()[2:]]
        self.assertEqual(code, 0)
        self.assertEqual(cells[0][:7], ["`crowd`", "2", "lanes", "200", "40", "25 %", "75 %"])
        self.assertEqual(cells[1][2:7], ["cycle lanes", "0", "10", "-", "0 %"])
        self.assertEqual(cells[2][7:], ["8", "50 %", "100 %"])

    def test_names_a_run_that_fails(self):
        code, text, errors = self.printed("--scenario", "broken", "crowd", "--seeds", "4")
        self.assertEqual(code, 1)
        self.assertIn("broken, seed 4: exit code 1: no such scenario", errors)
        self.assertIn("`crowd`", text)

    def test_takes_what_is_there(self):
        _, before, _ = self.printed("--scenario", "crowd", "--seeds", "4")
        self.program.write_text("#!/bin/sh\nexit 1\n")
        self.assertEqual(self.printed("--scenario", "crowd", "--seeds", "4", "--again")[:2], (0, before))
        self.assertEqual(self.printed("--scenario", "crowd", "--seeds", "4")[0], 1)

    def test_replaces_what_is_between_the_markers(self):
        page = f"before\n{lanes_table.BEGIN}\nold\n{lanes_table.END}\nafter\n"
        self.assertEqual(lanes_table.page_with(page, "new"), page.replace("old", "new"))


if __name__ == "__main__":
    unittest.main()
