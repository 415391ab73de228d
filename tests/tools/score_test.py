"""examples/score: its page, its table, and what it does where a run fails."""

import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCORE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "score"
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("score", str(SCORE))
score = importlib.util.module_from_spec(importlib.util.spec_from_loader("score", loader))
sys.modules["score"] = score
loader.exec_module(score)


class Page(unittest.TestCase):
    def test_gets_the_section_at_its_end_and_has_it_replaced_later(self):
        page = score.page_with("# Results\n\nFigures.\n", "old table")
        self.assertTrue(page.startswith("# Results\n\nFigures.\n"))
        self.assertIn(f"{score.HEADING}\n\n{score.BEGIN}\nold table\n{score.END}\n", page)
        again = score.page_with(page + "\n## Later\n", "new table")
        self.assertEqual(again, page.replace("old table", "new table") + "\n## Later\n")


class Table(unittest.TestCase):
    def test_has_a_cell_for_every_figure_and_says_what_failed(self):
        figures = [None] + [0.12345] * (len(score.FIGURES) - 1)
        lines = score.table([(("block", "standard", "greedy"), figures), (("block", "icp", "greedy"), None)]).splitlines()
        self.assertEqual({line.count("|") for line in lines}, {len(score.FIGURES) + 4})
        self.assertTrue(lines[2].startswith("| block | standard | greedy |  | 0.123 |"), lines[2])
        self.assertIn("| failed |", lines[3])

    def test_compares_trackers_only_where_the_truth_has_objects(self):
        data = pathlib.Path("data")
        self.assertEqual(len(score.combinations(score.recorded(data, "a", "a.log", True))), len(score.LOCALIZATIONS) * len(score.TRACKINGS))
        self.assertEqual(len(score.combinations(score.recorded(data, "a", "a.log", False))), len(score.LOCALIZATIONS))

    def test_leaves_out_recorded_drives_that_are_absent(self):
        names = [drive.name for drive in score.drives(pathlib.Path("/nowhere"), [1, 2])]
        self.assertEqual(names, [f"scenario {name}" for name in score.SCENARIOS])


class Command(unittest.TestCase):
    def call(self, *arguments):
        return subprocess.run([sys.executable, str(SCORE), *map(str, arguments)], capture_output=True, text=True, check=False)

    def test_wants_a_program(self):
        outcome = self.call("--binary", "/nowhere/slammot")
        self.assertEqual(outcome.returncode, 2)
        self.assertIn("no such program", outcome.stderr)

    def test_goes_on_after_a_run_that_fails_and_says_so_at_the_end(self):
        with tempfile.TemporaryDirectory() as folder:
            outcome = self.call("--binary", "/bin/false", "--data", "/nowhere", "--only", "scenario block", "--seeds", "1", "--output", folder)
        self.assertEqual(outcome.returncode, 1)
        rows = outcome.stdout.splitlines()[2:]
        self.assertEqual(len(rows), len(score.LOCALIZATIONS) * len(score.TRACKINGS))
        self.assertTrue(all(row.endswith("| failed |") for row in rows), outcome.stdout)
        self.assertIn("FAILS: scenario block, standard, standard; see", outcome.stderr)


if __name__ == "__main__":
    unittest.main()
