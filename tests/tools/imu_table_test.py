"""The table of drives with and without an IMU, with a program that makes the figures up."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
words = dict(zip(sys.argv[3::2], sys.argv[4::2])) if sys.argv[1] == "simulate" else dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "simulate":
    assert "imu { rate_hz: 100 }" in pathlib.Path(sys.argv[2]).read_text()
    folder = pathlib.Path(words["--output"])
    (folder / "drive.log").write_text("IMU 0\\nFLASER 0\\n")
    (folder / "drive.tum").write_text("")
elif sys.argv[1] == "run":
    folder = pathlib.Path(words["--output"])
    folder.mkdir()
    (folder / "log").write_text(pathlib.Path(words["--input"]).read_text())
else:
    folder = pathlib.Path(words["--result"])
    error = WITH if "IMU" in (folder / "log").read_text() else 0.5
    (folder / "evaluation.json").write_text(json.dumps({"trajectory": {"ate_m": {"rmse": error}}}))
"""


class ImuTable(unittest.TestCase):
    def table(self, with_imu):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "slammot"
            program.write_text(PROGRAM.replace("WITH", str(with_imu)))
            program.chmod(0o755)
            return subprocess.run([sys.executable, HERE / "imu_table.py", "--scenario", "city", "--seeds", "1-2", "--ways", "as-driven",
                                   "--binary", program, "--output", pathlib.Path(folder) / "out"], capture_output=True, text=True)

    def test_runs_the_same_drive_without_the_lines_of_the_imu(self):
        done = self.table(0.25)
        self.assertIn("| `city` | as-driven | 0.500 | 0.250 |", done.stdout, done.stderr)
        self.assertEqual(0, done.returncode)

    def test_fails_where_the_imu_makes_drives_worse(self):
        self.assertEqual(1, self.table(0.75).returncode)


if __name__ == "__main__":
    unittest.main()
