"""The structure check catches each violation that it is there for, and lets the ordinary pass."""

import tempfile
import unittest
from pathlib import Path

import structure


def faults_in(files):
    """Faults of a made-up tree, {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        sources = [structure.Source(name, text) for name, text in files.items()]
        return list(structure.faults_of(sources, root))


class AlgorithmRing(unittest.TestCase):
    def test_may_include_the_standard_library_eigen_and_itself(self):
        self.assertEqual([], faults_in({
            "common/flow/a.hpp": "",
            "common/grids/b.cpp": '#include <vector>\n#include <Eigen/Core>\n#include "common/flow/a.hpp"\n',
        }))

    def test_may_not_include_clock_thread_stream_file_or_log(self):
        for header in ("chrono", "thread", "mutex", "iostream", "fstream", "spdlog/spdlog.h"):
            self.assertEqual(1, len(faults_in({"common/grids/b.cpp": f"#include <{header}>\n"})), header)

    def test_may_not_include_the_shell_ring(self):
        self.assertEqual(1, len(faults_in({
            "common/files/log.hpp": "", "common/grids/b.cpp": '#include "common/files/log.hpp"\n'})))

    def test_may_not_draw_hidden_randomness_or_read_a_clock(self):
        for call in ("std::random_device seed;", "auto t = std::chrono::steady_clock::now();", "int r = rand();"):
            self.assertEqual(1, len(faults_in({"common/filters/b.cpp": call + "\n"})), call)

    def test_may_speak_of_a_clock_in_a_comment(self):
        self.assertEqual([], faults_in({"common/filters/b.cpp": "// std::chrono::steady_clock is not for here\n"}))

    def test_solves_with_ceres_in_graphs_only(self):
        self.assertEqual([], faults_in({"common/graphs/b.cpp": "#include <ceres/ceres.h>\n"}))
        self.assertEqual(1, len(faults_in({"common/matching/b.cpp": "#include <ceres/ceres.h>\n"})))

    def test_is_the_same_for_cmake(self):
        ring = "# The algorithm ring: ...\nforeach(folder {})\n"
        every = " ".join(sorted(structure.ALGORITHM_FOLDERS))
        self.assertEqual([], faults_in({"common/CMakeLists.txt": ring.format(every)}))
        self.assertEqual(["common/CMakeLists.txt: not the algorithm ring of tests/structure: dds"],
                         faults_in({"common/CMakeLists.txt": ring.format(every + " dds")}))
        self.assertEqual(1, len(faults_in({"common/CMakeLists.txt": "foreach(folder geometry)\n"})))

    def test_covers_the_algorithm_of_an_example(self):
        self.assertEqual(1, len(faults_in({"examples/greedy/README.md": "", "examples/greedy/greedy.cpp": "#include <thread>\n"})))

    def test_covers_the_algorithm_of_a_service_but_not_the_file_that_joins_the_rings(self):
        shell = '#include "common/dds/writer.hpp"\n#include <thread>\n'
        readme = {"services/detection/README.md": "", "common/dds/writer.hpp": ""}
        self.assertEqual(2, len(faults_in({"services/detection/detector.cpp": shell, **readme})))
        self.assertEqual([], faults_in({"services/detection/detection_service.cpp": shell, **readme}))
        self.assertEqual([], faults_in({"services/detection/detection_service_inputs.cpp": shell, **readme}))


class Services(unittest.TestCase):
    def test_do_not_include_each_other(self):
        files = {"services/tracking/README.md": "", "services/detection/README.md": "",
                 "services/detection/detector.hpp": ""}
        include = '#include "services/detection/detector.hpp"\n'
        self.assertEqual(1, len(faults_in({**files, "services/tracking/tracking_service.cpp": include})))
        self.assertEqual([], faults_in({**files, "services/slammot/README.md": "",
                                        "services/slammot/run.cpp": include}))

    def test_are_not_included_by_common(self):
        self.assertIn("common/app/a.cpp:1: common includes a service: services/detection/detector.hpp", faults_in({
            "services/detection/README.md": "", "services/detection/detector.hpp": "",
            "common/app/a.cpp": '#include "services/detection/detector.hpp"\n'}))

    def test_are_included_by_no_example_and_an_example_by_the_command_line_alone(self):
        files = {"services/tracking/README.md": "", "services/slammot/README.md": "", "services/tracking/tracker.hpp": "",
                 "examples/greedy/README.md": "", "examples/greedy/greedy.hpp": ""}
        service, example = '#include "services/tracking/tracker.hpp"\n', '#include "examples/greedy/greedy.hpp"\n'
        self.assertEqual(1, len(faults_in({**files, "examples/greedy/greedy_service.cpp": service})))
        self.assertEqual(1, len(faults_in({**files, "services/tracking/tracking_service.cpp": example})))
        self.assertEqual(1, len(faults_in({**files, "common/app/a.cpp": example})))
        self.assertEqual([], faults_in({**files, "services/slammot/run.cpp": example, "examples/greedy/greedy_service.cpp": example}))

    def test_have_a_readme_and_a_short_main(self):
        self.assertEqual(["services/ingest: has no README.md"],
                         faults_in({"services/ingest/main.cpp": "int main() {}\n"}))
        self.assertEqual(1, len(faults_in({"services/ingest/README.md": "", "services/ingest/main.cpp": "\n" * 30})))


class Bus(unittest.TestCase):
    def test_is_seen_by_common_dds_and_common_wire_only(self):
        self.assertEqual([], faults_in({"common/dds/a.cpp": "#include <dds/dds.h>\n",
                                        "common/wire/a.cpp": '#include "laser_scan.h"\n'}))
        self.assertEqual(2, len(faults_in({"common/app/a.cpp": '#include <dds/dds.h>\n#include "laser_scan.h"\n'})))


class Idl(unittest.TestCase):
    def test_states_extensibility_of_every_struct(self):
        self.assertEqual([], faults_in({"idl/a.idl": "@final struct A {\n  long b;\n};\n"}))
        self.assertEqual(1, len(faults_in({"idl/a.idl": "struct A {\n  long b;\n};\n"})))

    def test_keys_every_topic_by_vehicle_first(self):
        good = "@appendable\nstruct A {\n  @key string<32> vehicle_id;\n  @key long n;\n};\n"
        self.assertEqual([], faults_in({"idl/a.idl": good}))
        self.assertEqual(1, len(faults_in({"idl/a.idl": "@final struct A {\n  @key long n;\n};\n"})))


class Tree(unittest.TestCase):
    def test_holds_nobodys_absolute_paths(self):
        path = "/" + "home/someone/log"
        self.assertEqual(1, len(faults_in({"docs/a.md": f"see {path}\n"})))
        self.assertEqual([], faults_in({"docs/a.md": 'see "$(mktemp -d)"/x and build/home/x\n'}))

    def test_links_its_pages_to_files_that_exist(self):
        page = "[here](b.md) and [there](https://example.org) and [below](#below)\n"
        self.assertEqual(["docs/a.md:1: a link to nothing: b.md"], faults_in({"docs/a.md": page}))
        self.assertEqual([], faults_in({"docs/a.md": page, "docs/b.md": ""}))

    def test_mirrors_the_code_in_its_unit_tests(self):
        self.assertEqual(1, len(faults_in({"tests/unit/common/gone/a_test.cpp": ""})))

    def test_writes_includes_from_its_top(self):
        self.assertEqual(1, len(faults_in({"common/app/a.hpp": "", "common/app/a.cpp": '#include "a.hpp"\n'})))


if __name__ == "__main__":
    unittest.main()
