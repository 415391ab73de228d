// Usage: joint_posterior [SEEDS] prints a table of means over this many seeds (20);
// joint_posterior SEEDS --into PAGE writes it into a page, between its markers.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "examples/joint_posterior/report.hpp"

int main(int argc, char** argv) {
  using namespace slammot::joint_posterior;
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  if (seeds < 1 || argc == 3 || argc > 4)
    return std::fputs("usage: joint_posterior [SEEDS [--into PAGE]]\n", stderr), 2;
  const std::string text = table(seeds, [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  });
  if (argc < 4) return std::fputs(text.c_str(), stdout) < 0;
  std::stringstream page;
  page << std::ifstream(argv[3]).rdbuf();
  const std::string changed = with_table(page.str(), text);
  if (changed.empty()) return std::fputs("joint_posterior: no markers there\n", stderr), 2;
  return !(std::ofstream(argv[3]) << changed);
}
