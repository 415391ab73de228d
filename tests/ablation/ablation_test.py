"""The comparisons of tests/ablation: figures, pairs, kept results, and the settings that are changed."""

import argparse
import importlib.machinery
import importlib.util
import json
import math
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(HERE))

import paired


def script(name):
    loader = importlib.machinery.SourceFileLoader(name, str(HERE / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


ablate = script("ablate")

PROGRAM = """#!/usr/bin/env python3
import json, pathlib, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "run":
    is_new = "other" in pathlib.Path(words["--config"]).read_text()
    folder = pathlib.Path(words["--output"])
    (folder / "value").write_text(str((0.6 if is_new else 0.5) + 0.01 * int(words["--seed"])))
    (folder / "report.json").write_text(json.dumps({"measured": {"stage_latency": {"tracking": {"p50_ms": 0.2}}}}))
    with open(folder.parents[2] / "calls", "a") as calls:
        calls.write("run\\n")
else:
    folder = pathlib.Path(words["--result"])
    hota = float((folder / "value").read_text())
    (folder / "evaluation.json").write_text(json.dumps({"tracking": {"hota": {"hota": hota}}}))
"""


class Paired(unittest.TestCase):
    def compare(self, folder, seeds):
        options = argparse.Namespace(binary=folder / "program", output=str(folder / "out"), minutes=None, jobs=1)
        options.binary.write_text(PROGRAM)
        options.binary.chmod(0o755)
        drives = [paired.simulated("block", seed) for seed in seeds]
        return paired.compare(drives, ("defaults", ""), ("other", "other"), options)

    def test_states_the_difference_of_pairs_with_its_standard_error(self):
        with tempfile.TemporaryDirectory() as name:
            runs = self.compare(pathlib.Path(name), (1, 2, 3))
            change, error = paired.difference(*paired.pairs_of(runs["block"], "HOTA"))
            self.assertAlmostEqual(change, 0.1)
            self.assertAlmostEqual(error, 0.0)
            self.assertIn("| block | 3 | 0.5200 / 0.6200 (+0.1000 ± 0.0000)", paired.table(runs))

    def test_goes_on_where_it_was_interrupted(self):
        with tempfile.TemporaryDirectory() as name:
            self.compare(pathlib.Path(name), (1, 2))
            self.compare(pathlib.Path(name), (1, 2, 3))
            self.assertEqual((pathlib.Path(name) / "out" / "calls").read_text().count("run"), 6)

    def test_names_a_drive_that_fails(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            options = argparse.Namespace(binary="/bin/false", output=str(folder), minutes=None, jobs=1)
            runs = paired.compare([paired.simulated("block", 1)], ("a", ""), ("b", ""), options)
            self.assertEqual(runs, {"block": [(None, None)]})
            self.assertIn("| block | 0 |", paired.table(runs))

    def test_says_that_one_pair_has_no_scatter(self):
        self.assertTrue(math.isnan(paired.difference([1.0], [2.0])[1]))


class Ablate(unittest.TestCase):
    def test_changes_numbers_and_switches(self):
        text = "detection {\n  range_noise_m: 3\n}\ntracking {\n  formations: false\n  least_hits: 5\n  gate_margin_m: 0.3\n}\n"
        values = ablate.values_of(text)
        self.assertEqual([name for name, _ in ablate.changes_of("birth_score", "-3")], ["birth_score--4.5", "birth_score--1.5"])
        self.assertEqual(ablate.changes_of("publish_score", "0"), [], "nothing times a factor is nothing")
        self.assertEqual(values, [("formations", "false"), ("least_hits", "5"), ("gate_margin_m", "0.3")])
        self.assertEqual(ablate.changes_of(*values[0]), [("formations-on", "tracking { formations: true }")])
        self.assertEqual([name for name, _ in ablate.changes_of(*values[1])], ["least_hits-2", "least_hits-8"])
        self.assertEqual([name for name, _ in ablate.changes_of(*values[2])], ["gate_margin_m-0.15", "gate_margin_m-0.45"])

    def test_measures_differences_in_standard_errors(self):
        runs = [({"HOTA": 0.5}, {"HOTA": 0.51}), ({"HOTA": 0.6}, {"HOTA": 0.63})]
        effect = ablate.effect_on(runs, "HOTA")
        self.assertAlmostEqual(effect.change, 0.02)
        self.assertAlmostEqual(effect.sigmas, 2.0)
        self.assertTrue(effect.shows(1.9, 0.019))
        self.assertFalse(effect.shows(2.1, 0.019))
        self.assertFalse(effect.shows(1.9, 0.021), "a difference this small does not matter")
        self.assertFalse(ablate.effect_on([({"HOTA": 0.5}, {"HOTA": 0.5})] * 2, "HOTA").shows(0.1, 0.0))
        self.assertFalse(ablate.effect_on([], "HOTA").shows(0.0, 0.0))


if __name__ == "__main__":
    unittest.main()
