"""The table of the 2.5-D model."""

import contextlib
import io
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import model_table
from table_case import cells

PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
folder = pathlib.Path(words.get("--output") or words["--result"])
folder.mkdir(exist_ok=True)
if sys.argv[1] == "model":
    (folder / "model.json").write_text(json.dumps({"points": 12345, "accuracy": {
        "point_distance_median_m": 0.02, "point_distance_p95_m": 0.07, "astray_share": 0.0012, "wall_facades": int(folder.name),
        "wall_top_error_median_m": 0.1, "wall_top_error_p95_m": 3.0, "wall_top_bias_m": -0.1, "residue_share": 0.0008}}))
"""


class ModelTable(unittest.TestCase):
    def printed(self, *arguments):
        out, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(errors):
            code = model_table.main(list(arguments))
        return code, out.getvalue(), errors.getvalue()

    def test_has_a_row_for_each_seed(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "program"
            program.write_text(PROGRAM)
            program.chmod(0o755)
            code, text, _ = self.printed("--binary", str(program), "--seeds", "7,9")
        self.assertEqual(code, 0)
        self.assertEqual(cells(text)["7"], ["12,345", "0.020 / 0.070", "0.12 %", "7, 0.10 / 3.00 / -0.10", "0.080 %"])
        self.assertEqual(cells(text)["9"][3], "9, 0.10 / 3.00 / -0.10")

    def test_names_a_missing_program(self):
        code, _, errors = self.printed("--binary", "no-such-program")
        self.assertEqual(code, 2)
        self.assertIn("no-such-program is missing", errors)


if __name__ == "__main__":
    unittest.main()
