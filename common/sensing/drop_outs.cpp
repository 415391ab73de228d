#include "common/sensing/drop_outs.hpp"

#include <cmath>

namespace slammot::sensing {
namespace {

constexpr double kOneSurface_m = 0.3;  // greatest difference of range between two beams with one
                                       // between, and what a metre of range adds
constexpr double kOneSurfacePerM = 0.03;
constexpr std::size_t kFewestOnSurface = 20;  // beams between two on one surface: fewer tell no
                                              // share
constexpr double kByChance = 0.01;
constexpr double kHarmless = 0.1;  // share of drop-outs: nine of ten beams see the wall, and what
                                   // answers in part, such as a dark car, is no drop-out
constexpr std::size_t kLongestRun = 10;

bool has_echo_at(const LaserScan& scan, std::size_t beam) {
  return is_echo(scan.range_m[beam], scan.scanner.max_range_m);
}

double drop_out_share(const LaserScan& scan) {
  std::size_t on_surface = 0;
  std::size_t without_echo = 0;
  for (std::size_t i = 1; i + 1 < scan.range_m.size(); ++i) {
    if (!has_echo_at(scan, i - 1) || !has_echo_at(scan, i + 1)) continue;
    const float before_m = scan.range_m[i - 1];
    if (std::abs(before_m - scan.range_m[i + 1]) > kOneSurface_m + kOneSurfacePerM * before_m)
      continue;
    ++on_surface;
    if (!has_echo_at(scan, i)) ++without_echo;
  }
  if (on_surface < kFewestOnSurface) return 0.0;
  return static_cast<double>(without_echo) / static_cast<double>(on_surface);
}

}  // namespace

std::size_t shortest_free_run(const LaserScan& scan) {
  const double share = drop_out_share(scan);
  std::size_t length = 1;
  if (share < kHarmless) return length;
  for (double chance = share; chance > kByChance && length < kLongestRun; chance *= share) ++length;
  return length;
}

void mark_drop_outs(const LaserScan& scan, std::vector<bool>& may_be_drop_out) {
  const std::size_t beams = scan.range_m.size();
  may_be_drop_out.assign(beams, false);
  const std::size_t shortest = shortest_free_run(scan);
  if (shortest == 1) return;
  for (std::size_t first = 0, end = 0; first < beams; first = end + 1) {
    for (end = first; end < beams && !has_echo_at(scan, end);) ++end;
    if (end - first >= shortest) continue;
    for (std::size_t i = first; i < end; ++i) may_be_drop_out[i] = true;
  }
}

}  // namespace slammot::sensing
