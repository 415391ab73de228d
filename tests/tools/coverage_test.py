"""coverage.py sums counts of a line over programs, leaves out what is not the tree's own, and prints shares by folder."""

import collections
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "deploy" / "tools"))
import coverage  # noqa: E402  pylint: disable=wrong-import-position


def report(path, counts):
    lines = [{"line_number": number, "count": count} for number, count in counts.items()]
    return {"current_working_directory": "/tree/build", "files": [{"file": path, "lines": lines}]}


def summed(*reports):
    lines = collections.defaultdict(collections.Counter)
    coverage.add(reports, "/tree", lines)
    return lines


class Coverage(unittest.TestCase):
    def test_counts_a_line_that_one_of_two_programs_ran(self):
        lines = summed(report("../common/a/a.cpp", {1: 0, 2: 0}), report("../common/a/a.cpp", {1: 3, 2: 0}))
        self.assertEqual({"common/a": (1, 2)}, coverage.by_folder(lines))

    def test_leaves_out_libraries_and_tests(self):
        self.assertEqual({}, summed(report("/usr/include/vector", {1: 1}), report("../tests/unit/a_test.cpp", {1: 1})))

    def test_prints_a_share_for_each_folder_and_all(self):
        text = coverage.table({"common/a": (1, 2), "services/b": (3, 6)})
        self.assertEqual(["common/a", "1", "2", "50.0", "%", "services/b", "3", "6", "50.0", "%", "all", "4", "8", "50.0", "%"],
                         text.split())


if __name__ == "__main__":
    unittest.main()
