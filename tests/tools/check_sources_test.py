"""check_sources.py finds the sources that it should, runs the command that it should, and fails on a finding."""

import contextlib
import io
import json
import pathlib
import shutil
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "deploy" / "tools"
sys.path.insert(0, str(TOOLS))
import check_sources  # noqa: E402  pylint: disable=wrong-import-position


class Commands(unittest.TestCase):
    def test_lose_their_output_and_launcher_and_gain_warnings_as_errors(self):
        words = "/usr/bin/cmake -E env A=b ccache /usr/bin/clang++ -DX -MD -MT a.o -MF a.d -o a.o -c a.cpp".split()
        self.assertEqual("/usr/bin/clang++ -DX a.cpp -Werror -fsyntax-only".split(), check_sources.without_output(words))

    def test_lose_their_precompiled_header_and_keep_other_words_for_clang(self):
        words = "clang++ -Winvalid-pch -Xclang -include-pch -Xclang a.pch -Xclang -include -Xclang a.hxx -Xclang -w -c a.cpp".split()
        self.assertEqual("clang++ -Xclang -w -c a.cpp".split(), check_sources.without_precompiled_headers(words))

    def test_are_those_of_the_trees_own_sources(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            entries = [{"directory": folder, "file": name, "command": "clang++ -c " + name}
                       for name in ("common/a.cpp", "build/generated.cpp", f"{folder}/tests/b.cpp")]
            (root / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
            self.assertEqual({"common/a.cpp", "tests/b.cpp"}, set(check_sources.commands_of(root, root)))


class Selection(unittest.TestCase):
    def test_of_what_changed_holds_changed_sources_and_those_that_include_a_changed_header(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "common").mkdir()
            (root / "common/a.cpp").write_text('#include "common/a.hpp"\n', encoding="utf-8")
            (root / "common/b.cpp").write_text("", encoding="utf-8")
            (root / "common/c.cpp").write_text("", encoding="utf-8")
            sources = ["common/a.cpp", "common/b.cpp", "common/c.cpp"]
            self.assertEqual(["common/a.cpp", "common/b.cpp"],
                             check_sources.affected(sources, {"common/a.hpp", "common/b.cpp"}, root))
            self.assertEqual([], check_sources.affected(sources, {"docs/a.md"}, root))


@unittest.skipUnless(shutil.which("clang++"), "clang++ is not installed")
class Check(unittest.TestCase):
    def status_of(self, code, kind="syntax"):
        """Exit code and text of a check of one file with this code."""
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            source = root / "tests" / "a.cpp"
            source.parent.mkdir()
            source.write_text(code, encoding="utf-8")
            entry = {"directory": folder, "file": str(source), "command": f"clang++ -Wall -c {source} -o a.o"}
            (root / "compile_commands.json").write_text(json.dumps([entry]), encoding="utf-8")
            printed = io.StringIO()
            (root / ".clang-tidy").write_text("Checks: '-*,bugprone-sizeof-expression'\nWarningsAsErrors: '*'\n", encoding="utf-8")
            with contextlib.redirect_stdout(printed):
                return check_sources.main([folder, kind], root), printed.getvalue()

    def test_finds_in_chosen_files_what_relies_on_a_precompiled_header(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            source = root / "tests" / "a.cpp"
            source.parent.mkdir()
            source.write_text("int main() { return zero; }\n", encoding="utf-8")
            (root / "all.hpp").write_text("constexpr int zero = 0;\n", encoding="utf-8")
            entry = {"directory": folder, "file": str(source),
                     "command": f"clang++ -Xclang -include -Xclang {root}/all.hpp -c {source} -o a.o"}
            (root / "compile_commands.json").write_text(json.dumps([entry]), encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(0, check_sources.main([folder, "syntax"], root))
                self.assertEqual(1, check_sources.main([folder, "syntax", str(source)], root))

    def test_passes_clean_code(self):
        self.assertEqual(0, self.status_of("int main() {}\n")[0])

    def test_fails_on_a_warning_and_prints_it(self):
        code, text = self.status_of("int main() { int unused; }\n")
        self.assertEqual(1, code)
        self.assertIn("unused variable", text)

    @unittest.skipUnless(shutil.which("clang-tidy"), "clang-tidy is not installed")
    def test_by_tidy_fails_on_a_bug_alone(self):
        self.assertEqual(0, self.status_of("int main() { int unused; }\n", "tidy")[0])
        code, text = self.status_of("int main() { return sizeof(sizeof(int)); }\n", "tidy")
        self.assertEqual(1, code)
        self.assertIn("bugprone-sizeof-expression", text)


if __name__ == "__main__":
    unittest.main()
