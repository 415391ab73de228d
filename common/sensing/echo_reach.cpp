#include "common/sensing/echo_reach.hpp"

#include <algorithm>
#include <array>

namespace slammot::sensing {
namespace {

/// So many echoes of one scan reach as far: fewer are reflectors, or false.
constexpr std::size_t kEchoesAtReach = 3;

/// The range that kEchoesAtReach echoes have or exceed; 0 if there are fewer.
double reach_of(const LaserScan& scan) {
  std::array<float, kEchoesAtReach> farthest_m{};  // ascending
  for (const float range_m : scan.range_m) {
    if (!is_echo(range_m, scan.scanner.max_range_m) || range_m <= farthest_m.front()) continue;
    farthest_m.front() = range_m;
    std::ranges::sort(farthest_m);
  }
  return static_cast<double>(farthest_m.front());
}

}  // namespace

void EchoReach::add(const LaserScan& scan) {
  const auto same = std::ranges::find(reaches_, scan.scanner.scanner_id, &Reach::scanner_id);
  if (same == reaches_.end()) reaches_.push_back({scan.scanner.scanner_id, reach_of(scan)});
  else same->reach_m = std::max(same->reach_m, reach_of(scan));
}

double EchoReach::reach_m(const std::string& scanner_id) const {
  const auto same = std::ranges::find(reaches_, scanner_id, &Reach::scanner_id);
  return same == reaches_.end() ? 0.0 : same->reach_m;
}

}  // namespace slammot::sensing
