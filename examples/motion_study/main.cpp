// Usage: motion_study [SEEDS] prints tables of means over this many seeds (100);
// motion_study --trace [SEED] prints one run of each method as CSV.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "examples/motion_study/report.hpp"

int main(int argc, char** argv) {
  const bool traces = argc > 1 && std::string(argv[1]) == "--trace";
  const int position = traces ? 2 : 1;
  const int fallback = traces ? 1 : 100;
  const int number = argc > position ? std::atoi(argv[position]) : fallback;
  if (number < 1 || argc > position + 1) {
    std::fputs("usage: motion_study [SEEDS] | motion_study --trace [SEED]\n", stderr);
    return 2;
  }
  std::fputs(traces ? slammot::motion_study::traces(static_cast<unsigned>(number)).c_str()
                    : slammot::motion_study::tables(number).c_str(),
             stdout);
  return 0;
}
