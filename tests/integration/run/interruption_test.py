#!/usr/bin/env python3
"""Presses Ctrl-C in the middle of `slammot run` and `bench`, at a terminal, and looks at what is left.

usage: interruption_test.py SLAMMOT
"""

import json
import os
import pathlib
import pty
import re
import signal
import subprocess
import sys
import tempfile
import unittest

CTRL_C = b"\x03"
INTERRUPTED = 130
UNDER_WAY = r"[1-9][0-9] %"  # a tenth is done


class AtATerminal:
    """A program whose terminal is ours: what it shows can be read, and keys can be pressed."""

    def __init__(self, words):
        self.shown = ""
        self.process, self.terminal = pty.fork()
        if self.process == 0:
            os.execv(words[0], [str(word) for word in words])

    def read(self):
        """False at the end."""
        try:
            text = os.read(self.terminal, 65536).decode()
        except OSError:  # how a terminal says that nobody is there any more
            return False
        self.shown += text
        return bool(text)

    def read_until(self, pattern):
        while not re.search(pattern, self.shown):
            if not self.read():
                raise AssertionError(f"it has ended without '{pattern}':\n{self.shown}")

    def press(self, key):
        os.write(self.terminal, key)

    def end(self):
        """Exit code; negative for a signal."""
        while self.read():
            pass
        os.close(self.terminal)
        return os.waitstatus_to_exitcode(os.waitpid(self.process, 0)[1])


class Interruption(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-interruption-test-")
        cls.work = pathlib.Path(cls.folder.name)
        cls.log = cls.work / "block.log"
        subprocess.run([cls.slammot, "simulate", "block", "--output", cls.work], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([cls.slammot, "run", "--input", cls.log, "--output", cls.work / "whole"], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def start(self, name, *more, command="run"):
        return AtATerminal([self.slammot, command, "--input", self.log, "--output", self.work / name, *more])

    def poses(self, name):
        return (self.work / name / "online.tum").read_text().splitlines()

    def test_ctrl_c_leaves_the_results_of_what_was_driven(self):
        self.check_results_of_what_was_driven("run", "10", UNDER_WAY)

    def test_ctrl_c_of_bench_leaves_them_too(self):
        self.check_results_of_what_was_driven("bench", "4", UNDER_WAY)

    def check_results_of_what_was_driven(self, command, speed, is_driving):
        run = self.start("interrupted-" + command, "--speed", speed, command=command)
        run.read_until(is_driving)
        run.press(CTRL_C)
        self.assertEqual(run.end(), INTERRUPTED, run.shown)
        last_line = run.shown.splitlines()[-1]
        self.assertRegex(last_line, r"^slammot: interrupted: only the first [0-9.]+ s of the drive were processed$")
        poses = self.poses("interrupted-" + command)
        self.assertGreater(len(poses), 10)
        self.assertLess(len(poses), len(self.poses("whole")))
        if command == "run":  # services that are given more than they can do leave scans out
            self.assertEqual(poses, self.poses("whole")[:len(poses)])
        files = {file.name for file in (self.work / "whole").iterdir()}
        self.assertEqual({file.name for file in (self.work / ("interrupted-" + command)).iterdir()}, files)
        report = json.loads((self.work / ("interrupted-" + command) / "report.json").read_text())
        self.assertTrue(report["is_interrupted"])
        self.assertGreaterEqual(report["counts"]["scans"], len(poses))
        self.assertLess(report["counts"]["scans"], len(self.poses("whole")))

    def test_a_slow_drive_does_not_keep_one_waiting(self):
        run = self.start("slow", "--speed", "0.0001")  # the second scan is due in minutes
        run.read_until("%")
        run.press(CTRL_C)
        self.assertEqual(run.end(), INTERRUPTED, run.shown)
        self.assertIn("slammot: interrupted", run.shown)

    def test_sigterm_does_the_same(self):
        run = self.start("terminated", "--speed", "10")
        run.read_until(UNDER_WAY)
        os.kill(run.process, signal.SIGTERM)
        self.assertEqual(run.end(), INTERRUPTED, run.shown)
        self.assertGreater(len(self.poses("terminated")), 10)

    def test_the_truth_of_a_simulated_drive_reaches_as_far_as_its_results(self):
        run = AtATerminal([self.slammot, "run", "--scenario", "block", "--output", self.work / "simulated", "--speed", "10"])
        run.read_until(UNDER_WAY)
        run.press(CTRL_C)
        self.assertEqual(run.end(), INTERRUPTED, run.shown)
        truth = (self.work / "simulated" / "truth.tum").read_text().splitlines()
        self.assertGreaterEqual(len(truth), len(self.poses("simulated")))
        self.assertEqual(truth[-1].count(" "), 7, truth[-1])


if __name__ == "__main__":
    Interruption.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
