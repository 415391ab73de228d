"""Sizes are counted as a reader would."""

import pathlib
import tempfile
import unittest

import sizes

CODE = """#include <vector>

namespace slammot {
namespace {

constexpr int kOne = 1;

int one() { return kOne; }

const std::vector<int> kTable = {
    1,
    2,
};

}  // namespace

int declared(int a,
             int b);

template <class T>
T Class::two(T a,
             T b) {
  if (a) {
    return b;
  }
  return a;
}

}  // namespace slammot
"""

HEADER = """class Filter {
 public:
  struct State {
    double x_m = 0.0;  ///< A comment; with a semicolon.
    std::map<int, std::function<void(int)>> of_id;
  };
  explicit Filter(int a) : a_(a) {}
  void update(const State& state,
              double time_s);
  int a() const { return a_; }

 private:
  static constexpr int kMost = 3;
  using Pair = std::pair<int, int>;
  bool holds(int a) const;

  int a_ = 0;
  State state_{0.0,
               {}};
  std::vector<State> all_;
};
"""


class Sizes(unittest.TestCase):
    def test_counts_the_lines_of_functions_with_their_heads(self):
        self.assertEqual([("one", 1), ("Class::two", 7)], sizes.functions(CODE))

    def test_counts_members_of_data_only(self):
        self.assertEqual([("State", 2), ("Filter", 3)], sizes.classes(HEADER))

    def test_reports_the_largest_of_a_folder(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "a.cpp").write_text(CODE)
            (pathlib.Path(folder) / "b.hpp").write_text(HEADER)
            (pathlib.Path(folder) / "README.md").write_text("no code\n" * 1000)
            lines = sizes.report(pathlib.Path(folder))
        self.assertEqual(f"  files: 2, median {(len(CODE.splitlines()) + len(HEADER.splitlines())) / 2:g}, "
                         f"max {len(CODE.splitlines())} (a.cpp)", lines[1])
        self.assertEqual("  functions: 2, median 4, max 7 (Class::two)", lines[2])
        self.assertEqual("  members: 2, median 2.5, max 3 (Filter)", lines[3])

    def test_counts_settings_by_group(self):
        page = "# Settings\n\n## map: of it\n\n| setting |\n|---|\n| `a.b` | m |\n| `a.c` | m |\n\n## motion: of it\n\n| `d` |\n"
        self.assertEqual({"map": 2, "motion": 1}, sizes.settings_by_group(page))


if __name__ == "__main__":
    unittest.main()
