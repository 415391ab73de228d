#!/usr/bin/env python3
"""Takes drives with several scanners through one process and through the services, and compares with each scanner alone.

usage: several_scanners_test.py SLAMMOT
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

def figures(evaluation):
    return {"ate_m": evaluation["trajectory"]["ate_m"]["rmse"], "hota": evaluation["tracking"]["hota"]["hota"]}


class SeveralScanners(unittest.TestCase):
    slammot = None

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="slammot-several-scanners-")
        cls.work = pathlib.Path(cls.folder.name)
        subprocess.run([cls.slammot, "simulate", "two_scanners", "--output", cls.work], check=True, stdout=subprocess.DEVNULL)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def take(self, command, name, log="two_scanners.log", scanners=None):
        options = ["--scanners", ",".join(scanners)] if scanners else []
        subprocess.run([self.slammot, command, "--input", self.work / log, "--profile", "urban", "--output", self.work / name, *options],
                       check=True, stdout=subprocess.DEVNULL, timeout=240)
        return self.work / name

    def stamps(self, result):
        return [line.split()[0] for line in (result / "online.tum").read_text().splitlines()]

    def judge(self, result):
        subprocess.run([self.slammot, "eval", "--result", result, "--truth", self.work / "two_scanners"], check=True, stdout=subprocess.DEVNULL)
        return figures(json.loads((result / "evaluation.json").read_text()))

    def test_both_are_better_than_either_alone_and_services_give_the_same(self):
        both_result = self.take("run", "both")
        both = self.judge(both_result)
        for scanner in ["ROBOTLASER1", "ROBOTLASER2"]:
            alone = self.judge(self.take("run", scanner, scanners=[scanner]))
            self.assertLess(both["ate_m"], alone["ate_m"], scanner)
            self.assertGreater(both["hota"], alone["hota"] + 0.1, scanner)
        bench_result = self.take("bench", "bench")
        bench = self.judge(bench_result)
        self.assertLess(abs(bench["ate_m"] - both["ate_m"]), 0.2 * both["ate_m"])
        self.assertLess(abs(bench["hota"] - both["hota"]), 0.01)
        self.assertEqual(self.stamps(bench_result), self.stamps(both_result))

    def test_goes_on_with_the_other_when_one_falls_silent(self):
        lines = (self.work / "two_scanners.log").read_text().splitlines(keepends=True)
        for silent in ["ROBOTLASER1", "ROBOTLASER2"]:
            kept = [line for i, line in enumerate(lines) if i < len(lines) // 2 or not line.startswith(silent)]
            (self.work / "silent.log").write_text("".join(kept))
            result = self.take("run", f"without_{silent}", log="silent.log")
            self.assertLess(self.judge(result)["ate_m"], 0.03, silent)  # 0.02 and 0.015; both to the end: 0.013
            counters = json.loads((result / "report.json").read_text())["counters"]["localization"]
            self.assertEqual((counters["astray"], counters["gaps"]), (0, 0), silent)

    def test_an_unknown_scanner_is_refused_in_one_line(self):
        asked = subprocess.run([self.slammot, "run", "--input", self.work / "two_scanners.log", "--scanners", "ROBOTLASER7", "--output", self.work / "refused"],
                               capture_output=True, text=True)
        self.assertEqual(asked.returncode, 1)
        self.assertIn("no scanner ROBOTLASER7: there are ROBOTLASER1, ROBOTLASER2", asked.stderr)


if __name__ == "__main__":
    SeveralScanners.slammot = sys.argv.pop(1)
    unittest.main(verbosity=2)
