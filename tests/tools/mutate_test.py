"""Each operator makes the fault that it is named for and no other; a run keeps its verdicts and leaves the checkout alone."""

import contextlib
import io
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import mutants
import mutate


def changed(line, operator):
    """What the line becomes under each mutant of the operator."""
    return [mutant.mutated_line() for mutant in mutants.mutants_of("a.cpp", line) if mutant.operator == operator]


class Operators(unittest.TestCase):
    def test_flip_signs_between_operands_and_before_them(self):
        self.assertEqual(["x = a - b;"], changed("x = a + b;", "sign"))
        self.assertEqual(["x += a;"], changed("x -= a;", "sign"))
        self.assertEqual(["return +a;"], changed("return -a;", "sign"))
        self.assertEqual(["f(+1.0, b);"], changed("f(-1.0, b);", "sign"))

    def test_leave_increments_pointers_and_exponents_alone(self):
        for line in ("++i;", "p->x = 1;", "double x = 1e-3;"):
            self.assertEqual([], changed(line, "sign"), line)

    def test_double_constants_but_not_zero_one_or_what_sizes_a_type(self):
        self.assertEqual(["double x = (2 * 0.5);"], changed("double x = 0.5;", "constant"))
        self.assertEqual(["n = (2 * 10'000);"], changed("n = 10'000;", "constant"))
        for line in ("n = 1;", "x = 0.0;", "Matrix<double, 4, 4> m;", "m.block<2, 2>(2, 2);", "a[3] = b;", "x2 = y;"):
            self.assertEqual([], changed(line, "constant"), line)

    def test_drop_a_term_a_factor_and_a_condition_with_all_that_is_in_its_brackets(self):
        self.assertEqual(["x = a;", "x = a + f(b, c) * e;", "x = a + f(b, c + d);"], changed("x = a + f(b, c + d) * e;", "term"))
        self.assertEqual(["if (a) return;"], changed("if (a && b(c, d)) return;", "term"))

    def test_leave_a_term_alone_that_goes_on_in_the_next_line(self):
        self.assertEqual([], changed("x = a + f(b,", "term"))

    def test_swap_comparisons_but_not_the_brackets_of_templates(self):
        self.assertEqual(["if (a > b) c();"], changed("if (a < b) c();", "comparison"))
        self.assertEqual(["return a <= b;"], changed("return a >= b;", "comparison"))
        self.assertEqual([], changed("std::vector<int> a;", "comparison"))

    def test_negate_the_whole_condition_behind_its_declaration(self):
        self.assertEqual(["if (!(f(a) && b)) c();"], changed("if (f(a) && b) c();", "condition"))
        self.assertEqual(["if (auto a = f(); !(a.b())) c();"], changed("if (auto a = f(); a.b()) c();", "condition"))
        self.assertEqual([], changed("if (const auto a = f()) c();", "condition"))
        self.assertEqual([], changed("if constexpr (kIs) c();", "condition"))

    def test_remove_calls_and_assignments_but_not_declarations_or_returns(self):
        for line in ("  tracks_.clear();", "  a.b = c;", "  x += f(y);", "  ++n_;", "  continue;"):
            self.assertEqual(["  ;"], changed(line, "statement"), line)
        for line in ("  double a = f();", "  return f();", "  Foo() = default;", "  const auto a = b;", "  f(a,"):
            self.assertEqual([], changed(line, "statement"), line)

    def test_leave_comments_literals_and_assertions_alone(self):
        for line in ("// x = a + 2.0;", 'log("a + 2.0", b);', "assert(a < b);", "static_assert(a < 2);", "#if A < 2", "/* a + 2.0 */"):
            self.assertEqual([], [mutant for mutant in mutants.mutants_of("a.cpp", line) if mutant.operator != "statement"], line)

    def test_find_code_beside_a_comment_and_across_lines_of_one(self):
        self.assertEqual(["x = (2 * 2.0);  // a + 3.0"], changed("x = 2.0;  // a + 3.0", "constant"))
        self.assertEqual([3], [mutant.line for mutant in mutants.mutants_of("a.cpp", "/* 2.0\n 3.0 */\nx = 4.0;\n") if mutant.operator == "constant"])


TEXT = "double f(double a) {\n  return a + 2.0;\n}\n"


class Mutants(unittest.TestCase):
    def test_change_nothing_but_their_line(self):
        for mutant in mutants.mutants_of("a.cpp", TEXT):
            before, after = TEXT.split("\n"), mutant.applied(TEXT).split("\n")
            self.assertEqual([mutant.line - 1], [i for i, (a, b) in enumerate(zip(before, after)) if a != b])
            self.assertEqual(len(before), len(after))

    def test_refuse_a_file_whose_line_has_changed(self):
        with self.assertRaises(ValueError):
            mutants.mutants_of("a.cpp", TEXT)[0].applied(TEXT.replace("a + 2.0", "a + 2.5"))

    def test_have_names_of_their_own(self):
        names = [mutant.id for mutant in mutants.mutants_of("a.cpp", TEXT)]
        self.assertEqual(3, len(names))  # sign, constant, term
        self.assertEqual(len(names), len(set(names)))

    def test_are_drawn_by_the_seed_file_after_file(self):
        files = {f"{name}.cpp": TEXT for name in "abcd"}
        order = mutants.drawn(files, 1)
        self.assertEqual(order, mutants.drawn(files, 1))
        self.assertNotEqual(order, mutants.drawn(files, 2))
        self.assertEqual(set(files), {mutant.path for mutant in order[:4]})
        self.assertEqual(sorted(mutant.id for path in files for mutant in mutants.mutants_of(path, TEXT)), sorted(mutant.id for mutant in order))

    def test_leave_out_tables_of_settings_and_mains(self):
        paths = [path for part in mutate.PARTS for path in mutate.sources_of(part, mutate.ROOT)]
        self.assertIn("services/detection/detector.cpp", paths)
        self.assertEqual([], [path for path in paths if path.endswith(("main.cpp", "_fields.cpp", "_service.cpp"))])


    def test_are_chosen_after_they_were_drawn(self):
        parts = mutate.PARTS[:1]
        all_of_them = mutate.drawn(parts, mutate.ROOT, 6, 1)
        first = all_of_them[0][1].id
        self.assertEqual([first], [mutant.id for _, mutant in mutate.drawn(parts, mutate.ROOT, 6, 1, only=(first[:-8] + "*",))])
        self.assertEqual(all_of_them[:3], mutate.drawn(parts, mutate.ROOT, 3, 1))


class FakeWorkshop:
    """Notices signs, does not compile terms, and passes all else."""

    def __init__(self):
        self.asked = []

    def verdict(self, mutant, tests, scenarios):
        self.asked.append(mutant.id)
        return {"sign": (mutate.CAUGHT, f"{tests[0]}: A.B"), "term": (mutate.NO_CODE, "")}.get(mutant.operator, (mutate.SURVIVED, ""))


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name) / "work" / "results.jsonl"
        self.draws = [(mutate.PARTS[0], mutant) for mutant in mutants.mutants_of("a.cpp", TEXT)]

    def run_once(self, again=()):
        workshop = FakeWorkshop()
        mutate.tried(self.draws, mutate.Results(self.path), workshop, (), again, say=lambda *_, **__: None)
        return workshop.asked

    def test_go_on_where_they_were_interrupted(self):
        self.assertEqual(3, len(self.run_once()))
        self.assertEqual([], self.run_once())
        rows = self.path.read_text().splitlines()
        self.path.write_text("\n".join([*rows[:2], rows[2][:20]]))  # cut off while it was written
        self.assertEqual([self.draws[2][1].id], self.run_once())
        self.assertEqual(3, len(mutate.Results(self.path).rows))

    def test_try_survivors_again_when_asked_to(self):
        self.run_once()
        self.assertEqual(["constant"], [name.split(":")[3] for name in self.run_once(again=(mutate.SURVIVED,))])

    def test_report_shares_of_those_that_compile_and_list_survivors(self):
        self.run_once()
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            mutate.report(self.draws, mutate.Results(self.path))
        self.assertRegex(said.getvalue(), r"detection +1 +1 +1 +50 %\n")
        self.assertRegex(said.getvalue(), r"a\.cpp:2 constant\n  - return a \+ 2\.0;\n  \+ return a \+ \(2 \* 2\.0\);")


class Failures(unittest.TestCase):
    def test_are_named_by_what_noticed(self):
        self.assertIsNone(mutate.failure_of(0, ""))
        self.assertEqual("A.B", mutate.failure_of(1, "x\n[  FAILED  ] A.B (3 ms)\n[  FAILED  ] C.D\n"))
        self.assertEqual("signal 11", mutate.failure_of(-11, ""))
        self.assertEqual("time limit", mutate.failure_of(None, ""))

    def test_include_running_on_and_end_what_was_started(self):
        code, _ = mutate.run_limited([sys.executable, "-c", "import time; time.sleep(60)"], 0.2)
        self.assertIsNone(code)
        self.assertEqual((3, "said\n"), mutate.run_limited([sys.executable, "-c", "print('said'); raise SystemExit(3)"], 60.0))


class Lock(unittest.TestCase):
    def test_lets_one_run_at_a_time_into_the_copy(self):
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder) / "work"
            with mutate.alone_in(work):
                with self.assertRaises(RuntimeError), mutate.alone_in(work):
                    pass
            with mutate.alone_in(work):
                pass


class Copy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.tree = pathlib.Path(folder.name) / "root", pathlib.Path(folder.name) / "tree"
        self.root.mkdir()
        subprocess.run(["git", "init", "--quiet", self.root], check=True)
        (self.root / ".gitignore").write_text("/build/\n")
        (self.root / "a.cpp").write_text(TEXT)
        (self.root / "build").mkdir()
        (self.root / "build" / "object").write_text("")
        mutate.copy_tree(self.root, self.tree)

    def test_has_what_git_knows_or_would_and_nothing_that_was_built(self):
        self.assertEqual(TEXT, (self.tree / "a.cpp").read_text())
        self.assertFalse((self.tree / "build" / "object").exists())

    def test_is_mended_where_a_mutant_was_left_and_untouched_elsewhere(self):
        (self.root / "b.cpp").write_text(TEXT)
        mutate.copy_tree(self.root, self.tree)
        for name in ("a.cpp", "b.cpp"):
            os.utime(self.tree / name, (1.0, 1.0))
        (self.tree / "a.cpp").write_text("a mutant")
        (self.tree / "left_over.cpp").write_text("")
        (self.tree / "build" / "kept").write_text("")
        mutate.copy_tree(self.root, self.tree)
        self.assertEqual(TEXT, (self.tree / "a.cpp").read_text())
        self.assertEqual(1.0, (self.tree / "b.cpp").stat().st_mtime)
        self.assertFalse((self.tree / "left_over.cpp").exists())
        self.assertTrue((self.tree / "build" / "kept").exists())

    def test_holds_the_mutant_while_it_is_tested_and_the_code_afterwards(self):
        mutant = mutants.mutants_of("a.cpp", TEXT)[0]
        seen = []

        class Workshop(mutate.Workshop):
            def build(self, target, keeps_objects):
                seen.append((self.tree / "a.cpp").read_text())
                return 1, "a.cpp:2: error: so it is"

        self.assertEqual((mutate.NO_CODE, "a.cpp:2: error: so it is"), Workshop(self.tree, 1).verdict(mutant, ("unit_a",)))
        self.assertEqual([mutant.applied(TEXT)], seen)
        self.assertEqual(TEXT, (self.tree / "a.cpp").read_text())
        self.assertEqual(TEXT, (self.root / "a.cpp").read_text())


if __name__ == "__main__":
    unittest.main()
