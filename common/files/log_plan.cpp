#include "common/files/log_plan.hpp"

#include <algorithm>

namespace slammot::files {

std::string enumerated(const std::vector<ScannerPlan>& scanners) {
  std::string names;
  for (const ScannerPlan& scanner : scanners) names += (names.empty() ? "" : ", ") + scanner.name;
  return names;
}

std::optional<Error> select_scanners(const std::vector<std::string>& wanted,
                                     std::vector<ScannerPlan>& scanners) {
  for (const std::string& name : wanted) {
    if (std::ranges::find(scanners, name, &ScannerPlan::name) == scanners.end())
      return Error{"no scanner " + name + ": there are " + enumerated(scanners)};
  }
  if (!wanted.empty())
    std::erase_if(scanners, [&](const ScannerPlan& scanner) {
      return std::ranges::find(wanted, scanner.name) == wanted.end();
    });
  return std::nullopt;
}

}  // namespace slammot::files
