#!/usr/bin/env python3
"""Takes a small drive through the real services over DDS, each on a closed bus of its own, and compares with one process.

usage: bench_test.py SLAMMOT
"""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "compose"))
from trajectory import aligned_rmse_m, read_tum  # noqa: E402

PATIENCE = float(os.environ.get("SLAMMOT_TEST_PATIENCE", 1))  # more for services built with sanitizers
SERVICES = ["ingest", "localization", "detection", "tracking", "loop-closing", "map-store"]


def children_of(process):
    """Names by process number, from /proc."""
    found = {}
    for status in pathlib.Path("/proc").glob("[0-9]*/status"):
        try:
            fields = dict(line.split(":\t", 1) for line in status.read_text().splitlines() if ":\t" in line)
            if int(fields["PPid"]) == process:
                found[int(fields["Pid"])] = (status.parent / "cmdline").read_text().split("\0")[0].rsplit("/", 1)[-1]
        except (OSError, KeyError):
            pass  # it has just ended
    return found


def wait_until(condition, what, within_s=30.0 * PATIENCE):
    end = time.monotonic() + within_s
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.02)
    raise AssertionError(f"waited {within_s} s for {what}")


class Bench(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-bench-test-")
        cls.work = pathlib.Path(cls.folder.name)
        for sanitizer in ["TSAN_OPTIONS", "ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS"]:  # those of services would be lost with their logs
            os.environ[sanitizer] = os.environ.get(sanitizer, "") + f":log_path={cls.work / 'sanitizer-report'}"
        subprocess.run([cls.slammot, "simulate", "block", "--output", cls.work], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([cls.slammot, "run", "--input", cls.work / "block.log", "--output", cls.work / "run"],
                       check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def start(self, name):
        return subprocess.Popen([self.slammot, "bench", "--input", self.work / "block.log", "--output", self.work / name],
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def end(self, bench, children):
        try:
            words, _ = bench.communicate(timeout=120 * PATIENCE)
        except subprocess.TimeoutExpired:
            bench.kill()
            raise
        for report in self.work.glob("sanitizer-report*"):
            self.fail(report.read_text())
        for process in children:
            self.assertFalse(pathlib.Path(f"/proc/{process}").exists(), f"left behind: {children[process]}\n{words}")
        return words

    def services_of(self, bench):
        def all_there():
            children = children_of(bench.pid)
            return children if len(children) == len(SERVICES) else None
        return wait_until(all_there, "six services")

    def ate_m(self, name):
        return aligned_rmse_m(read_tum(self.work / name / "trajectory.tum"), read_tum(self.work / "block.tum"))

    def confirmed_tracks(self, name):
        with open(self.work / name / "tracks.csv", newline="") as file:
            return len({row["track_id"] for row in csv.DictReader(file)})

    def rows(self, name):
        return len((self.work / name / "online.tum").read_text().splitlines())

    def test_services_give_what_one_process_gives(self):
        bench = self.start("bench")
        words = self.end(bench, self.services_of(bench))
        self.assertEqual(bench.returncode, 0, words)
        self.assertLess(abs(self.ate_m("bench") - self.ate_m("run")), 0.2 * self.ate_m("run"))
        tracks = self.confirmed_tracks("run")
        self.assertLessEqual(abs(self.confirmed_tracks("bench") - tracks), max(1, 0.05 * tracks))
        self.assertEqual(self.rows("bench"), self.rows("run"))

    def test_every_service_may_be_killed_once(self):
        bench = self.start("killed")
        children = self.services_of(bench)
        for service in SERVICES:
            name = f"slammot-{service}"
            victim = wait_until(lambda: next((p for p, n in children_of(bench.pid).items() if n == name), None), name)
            subprocess.run(["kill", "-9", str(victim)], check=True)
            wait_until(lambda: any(n == name and p != victim for p, n in children_of(bench.pid).items()), f"a new {name}")
        words = self.end(bench, children)
        self.assertEqual(bench.returncode, 0, words)
        self.assertLess(self.ate_m("killed"), 1.5 * self.ate_m("run"))
        self.assertEqual(self.rows("killed"), self.rows("run"))
        restarts = json.loads((self.work / "killed" / "report.json").read_text())["counters"]["bench"]
        self.assertEqual({f"restarts_of_{service}": 1 for service in SERVICES}, restarts)

    def test_nothing_is_left_after_ctrl_c(self):
        bench = self.start("interrupted")
        children = self.services_of(bench)
        bench.send_signal(signal.SIGINT)
        self.end(bench, children)
        self.assertEqual(bench.returncode, 130)


if __name__ == "__main__":
    Bench.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
