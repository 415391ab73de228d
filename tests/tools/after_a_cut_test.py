"""A drive that jumps is off from the cut on, and found again where its poses agree with the truth."""

import contextlib
import io
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

import after_a_cut

SCANS = 60
SPEED_MPS = 2.0
CUT_S = 20.0


def line(stamp_s, x, y, heading):
    return f"{stamp_s:.6f} {x:.6f} {y:.6f} 0 0 0 {math.sin(heading / 2):.9f} {math.cos(heading / 2):.9f}\n"


def straight(time_s):
    return SPEED_MPS * time_s, 0.0, 0.0


class Drive(unittest.TestCase):
    """A scan a second for a minute, straight ahead; the result has its own frame, turned by a quarter."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.copy = str(pathlib.Path(folder.name) / "cut")
        self.result = pathlib.Path(folder.name) / "result"
        self.result.mkdir()
        pathlib.Path(self.copy + ".tum").write_text("# truth\n" + "".join(line(100 + t, *straight(t)) for t in range(SCANS)))

    def write(self, name, error_m):
        """Poses off by error_m(time) along the way, in a frame turned by a quarter."""
        (self.result / name).write_text("".join(
            line(100 + t, 0.0, SPEED_MPS * t + error_m(t), math.pi / 2) for t in range(SCANS)))

    def says(self):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            after_a_cut.main(self.copy, str(self.result), CUT_S)
        return printed.getvalue().strip()

    def test_is_found_when_the_last_pose_off_by_more_than_a_metre_has_passed(self):
        self.write("online.tum", lambda t: 50.0 if CUT_S <= t <= 32 else 0.0)
        self.write("trajectory.tum", lambda t: 0.0 if t < 40 else 0.2)
        self.assertEqual("found after 12 s, error 0.20 m in the median, 0.20 m at worst", self.says())

    def test_counts_errors_from_8_s_after_the_cut_on(self):
        self.write("online.tum", lambda t: 0.0)
        self.write("trajectory.tum", lambda t: 0.0 if t < 20 else 9.0 if t < 28 else 0.5 if t == 59 else 0.1)
        self.assertEqual("found after 0 s, error 0.10 m in the median, 0.50 m at worst", self.says())

    def test_is_not_found_while_the_last_pose_is_off(self):
        self.write("online.tum", lambda t: 50.0 if t >= CUT_S else 0.0)
        self.write("trajectory.tum", lambda t: 50.0 if t >= CUT_S else 0.0)
        self.assertTrue(self.says().startswith("not found, error 50.00 m"))

    def test_names_a_file_that_is_not_there(self):
        script = pathlib.Path(__file__).with_name("after_a_cut.py")
        run = subprocess.run([sys.executable, script, self.copy, str(self.result), "20"], capture_output=True, text=True)
        self.assertEqual(1, run.returncode)
        self.assertIn("online.tum: No such file", run.stderr)


if __name__ == "__main__":
    unittest.main()
