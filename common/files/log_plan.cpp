#include "common/files/log_plan.hpp"

#include <algorithm>
#include <cmath>

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

std::int64_t LogPlan::odometry_lateness_ns(std::int64_t stamp_ns) const {
  const double since_ns =
      odometry_drift == 0.0 ? 0.0 : static_cast<double>(stamp_ns - odometry_late_at_ns);
  return std::llround(odometry_late_s * 1e9 + odometry_drift * since_ns);
}

}  // namespace slammot::files
