"""The table of occlusions: sums over runs, and its place in a page."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import occlusion_table
from table_case import TableCase
from tables import seeds_in

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
    band = lambda low, high, n: {"from_s": low, "to_s": high, "occlusions": n, "identity_kept": n // 2, "hidden_rows": 10 * n, "covered_rows": 3 * n}
    nees = None if seed == 3 else {"samples": seed, "mean": float(seed)}
    error = {"count": 1, "rmse": 3.0 if seed == 1 else 4.0}
    (folder / "evaluation.json").write_text(json.dumps({"occlusion": {
        "by_length": [band(0.15, 1.0, 2), band(1.0, 3.0, seed), band(3.0, 5.0, 0), band(5.0, 10.0, 4)],
        "position_m": error, "position_nees": nees, "inside_share": 0.5,
        "occluded_rows": {"at_own_object": 7, "at_other_object": 1, "at_nothing": 2, "precision": 0.7},
        "published_gaps": {"gaps": 5, "missing_rows": 9, "gaps_on_object": 3, "gaps_in_view": 1, "missing_rows_in_view": 1}}}))
"""


class OcclusionTable(TableCase):
    command = occlusion_table
    stand_in = PROGRAM

    def test_sums_counts_and_weighs_errors_with_their_samples(self):
        code, text, _ = self.printed("--scenario", "crowd", "--seeds", "1-2")
        cells = [cell.strip() for cell in text.splitlines()[2].strip("|").split("|")]
        self.assertEqual(code, 0)
        self.assertEqual(cells[:9], ["`crowd`", "2", "2 of 4", "1 of 3", "0 of 0", "4 of 8", "43 %", "75 %", "30 %"])
        self.assertEqual(cells[9:], ["3.54", "1.67 (3)", "0.50", "14 / 2 / 4", "6 / 2"])

    def test_leaves_out_what_a_run_does_not_have(self):
        _, text, _ = self.printed("--scenario", "crowd", "--seeds", "3")
        self.assertIn("| - (0) |", text)

    def test_names_a_run_that_fails(self):
        code, text, errors = self.printed("--scenario", "broken", "crowd", "--seeds", "4")
        self.assertEqual(code, 1)
        self.assertIn("broken, seed 4: exit code 1: no such scenario", errors)
        self.assertIn("`crowd`", text)

    def test_keeps_the_evaluation_only(self):
        self.printed("--scenario", "crowd", "--seeds", "4", "--config", "tracking {}")
        self.assertEqual({path.name for path in (self.folder / "out/crowd-4").iterdir()}, {"evaluation.json", "settings.textproto"})

    def test_replaces_what_is_between_the_markers(self):
        page = f"before\n{occlusion_table.BEGIN}\nold\n{occlusion_table.END}\nafter\n"
        self.assertEqual(occlusion_table.page_with(page, "new"), page.replace("old", "new"))
        with self.assertRaises(SystemExit):
            occlusion_table.page_with("no markers", "new")

    def test_reads_ranges_of_seeds(self):
        self.assertEqual(seeds_in("1-3,7"), [1, 2, 3, 7])


if __name__ == "__main__":
    unittest.main()
