"""The table of extents: rows pooled over runs."""

import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import extent_table
from table_case import TableCase, cells

PROGRAM = """#!/usr/bin/env python3
import pathlib, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "run":
    if words["--seed"] == "9":
        sys.exit("no such seed")
    (pathlib.Path(words["--output"]) / "seed").write_text(words["--seed"])
else:
    folder = pathlib.Path(words["--result"])
    seed = int((folder / "seed").read_text())
    row = lambda kind, distance, seen, iou, ahead, left: (
        f"1.0,3,{kind},7,{distance},20,{seen},8.0,4.5,1.8,4.4,1.8,{iou},{ahead},{left},-0.0349066,{seed}.0")
    header = ("stamp_s,object,class,track,distance_m,points,outline_seen,speed_mps,true_length_m,true_width_m,length_m,width_m,iou,ahead_m,"
              "left_m,turned_rad,velocity_error_mps")
    rows = [row("car", 15.0, 0.3, 0.9, 0.3, 0.4)] if seed == 1 else [row("bus", 35.0, 1.0, 0.5, 0.0, 1.5)]
    (folder / "vehicle_boxes.csv").write_text("\\n".join([header, *rows]) + "\\n")
"""


class ExtentTable(TableCase):
    command = extent_table
    stand_in = PROGRAM

    def test_pools_rows_of_all_runs(self):
        code, text, _ = self.printed("--seeds", "1-2")
        self.assertEqual(code, 0)
        self.assertEqual(cells(text)["all"], ["2", "0.700", "0.540", "1.45", "2.0", "1.58"])

    def test_groups_by_class_distance_and_outline(self):
        _, text, _ = self.printed("--seeds", "1-2")
        rows = cells(text)
        self.assertEqual(rows["car"], ["1", "0.900", "0.900", "0.50", "2.0", "1.00"])
        self.assertEqual(rows["10 to 20 m away"], rows["car"])
        self.assertEqual(rows["outline seen 20 to 40 %"], rows["car"])
        self.assertEqual(rows["outline seen 60 to 100 %"], rows["bus"])
        self.assertNotIn("0 to 10 m away", rows)

    def test_names_a_run_that_fails(self):
        code, text, errors = self.printed("--seeds", "1,9")
        self.assertEqual(code, 1)
        self.assertIn("seed 9: exit code 1: no such seed", errors)
        self.assertEqual(cells(text)["all"][0], "1")

    def test_lists_the_worst_and_reads_what_it_left(self):
        self.printed("--seeds", "1-2")
        self.program.unlink()
        code, text, _ = self.printed("--seeds", "1-2", "--read", "--worst", "1")
        self.assertEqual(code, 0)
        self.assertIn("seed 2 object 3 track 7 bus: 1 rows", text)
        self.assertEqual([path.name for path in (self.folder / "out/city_varied-1").iterdir()], ["vehicle_boxes.csv"])


if __name__ == "__main__":
    unittest.main()
