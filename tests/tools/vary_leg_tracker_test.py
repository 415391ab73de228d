"""Copies of a leg_tracker recording differ from it in what their name says, and in nothing else."""

import gzip
import pathlib
import subprocess
import sys
import tempfile
import unittest

import vary_leg_tracker

SCANS = 90
BEAMS = 40
HEADING = "stamp angle_min angle_max increment range_max ranges"


def scan(index):
    """Five words before the ranges; one beam has no echo, one is no number."""
    ranges = ["0", "nan", *(f"{1.0 + 0.01 * beam:.3f}" for beam in range(BEAMS - 2))]
    return " ".join([f"{index}.0", "-1.0", "1.0", "0.05", "10", *ranges])


SCAN_LINES = [scan(index) for index in range(SCANS)]


def ranges_of(lines):
    return [line.split()[vary_leg_tracker.FIRST_RANGE:] for line in lines]


class Variants(unittest.TestCase):
    def setUp(self):
        self.variants = dict(vary_leg_tracker.variants(SCAN_LINES))

    def test_are_22_of_which_the_first_is_the_recording(self):
        self.assertEqual(22, len(self.variants))
        self.assertEqual("base", next(iter(self.variants)))
        self.assertEqual(SCAN_LINES, self.variants["base"])

    def test_with_noise_move_each_range_by_millimetres(self):
        for name, sigma_m in (("noise1", 0.005), ("noise9", 0.01)):
            squares = [(float(new) - float(old)) ** 2 for new_scan, old_scan in zip(ranges_of(self.variants[name]), ranges_of(SCAN_LINES))
                       for new, old in zip(new_scan[2:], old_scan[2:])]
            rms_m = (sum(squares) / len(squares)) ** 0.5
            self.assertAlmostEqual(sigma_m, rms_m, delta=0.1 * sigma_m, msg=name)

    def test_with_noise_keep_stamps_and_what_is_no_echo(self):
        for new, old in zip(self.variants["noise1"], SCAN_LINES):
            self.assertEqual(old.split()[:vary_leg_tracker.FIRST_RANGE + 2], new.split()[:vary_leg_tracker.FIRST_RANGE + 2])

    def test_with_dark_beams_lose_one_echo_in_fifty_and_change_no_other(self):
        words = [(new, old) for new_scan, old_scan in zip(ranges_of(self.variants["dark1"]), ranges_of(SCAN_LINES))
                 for new, old in zip(new_scan[2:], old_scan[2:])]
        lost = [new == "inf" for new, _ in words]
        self.assertAlmostEqual(0.02, sum(lost) / len(lost), delta=0.01)
        self.assertTrue(all(new == old for (new, old), gone in zip(words, lost) if not gone))

    def test_begin_later_or_leave_out_every_sixth_or_ninth_scan(self):
        self.assertEqual(SCAN_LINES[25:], self.variants["late25"])
        self.assertEqual([line for i, line in enumerate(SCAN_LINES) if i % 9 != 4], self.variants["drop9_4"])

    def test_are_the_same_each_time_and_differ_by_seed(self):
        self.assertEqual(self.variants, dict(vary_leg_tracker.variants(SCAN_LINES)))
        self.assertNotEqual(self.variants["noise1"], self.variants["noise2"])


class Copies(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.recording = pathlib.Path(folder.name) / "recording"
        self.copies = pathlib.Path(folder.name) / "copies"
        self.recording.mkdir()
        with gzip.open(self.recording / "scan.txt.gz", "wt") as file:
            file.write("\n".join([HEADING, *SCAN_LINES]) + "\n")
        (self.recording / "odom.txt").write_text("odometry\n")
        (self.recording / "people_gt.txt").write_text("people\n")

    def test_are_recordings_themselves(self):
        vary_leg_tracker.main(self.recording, self.copies)
        self.assertEqual(22, len(list(self.copies.iterdir())))
        for copy in self.copies.iterdir():
            self.assertEqual(HEADING, (copy / "scan.txt").read_text().splitlines()[0], copy.name)
            self.assertEqual("odometry\n", (copy / "odom.txt").read_text(), copy.name)
            self.assertEqual("people\n", (copy / "people_gt.txt").read_text(), copy.name)

    def test_need_a_recording_and_a_folder(self):
        script = pathlib.Path(__file__).with_name("vary_leg_tracker.py")
        run = subprocess.run([sys.executable, script, str(self.recording)], capture_output=True, text=True)
        self.assertEqual(1, run.returncode)
        self.assertIn("usage: vary_leg_tracker.py RECORDING FOLDER", run.stderr)


if __name__ == "__main__":
    unittest.main()
