// Usage: joint_posterior [SEEDS] prints a table of means over this many seeds (20);
// joint_posterior SEEDS --into PAGE writes it into a page, between its markers.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "examples/joint_posterior/report.hpp"

int main(int argc, char** argv) {
  using namespace slammot::joint_posterior;
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  const bool writes = argc == 4 && std::string(argv[2]) == "--into";
  if (seeds < 1 || (argc > 2 && !writes)) {
    std::fputs("usage: joint_posterior [SEEDS] | joint_posterior SEEDS --into PAGE\n", stderr);
    return 2;
  }
  const std::string text = table(seeds);
  if (!writes) return std::fputs(text.c_str(), stdout) < 0;
  std::stringstream page;
  page << std::ifstream(argv[3]).rdbuf();
  const std::string changed = with_table(page.str(), text);
  if (changed.empty()) {
    std::fprintf(stderr, "joint_posterior: %s has no markers for the table\n", argv[3]);
    return 2;
  }
  return !(std::ofstream(argv[3]) << changed);
}
