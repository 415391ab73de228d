#include "services/detection/clutter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace slammot::detection {
namespace {

constexpr double kThinnestM = 0.08;      ///< Of what may move: a leg.
constexpr double kStandsOffM = 0.15;     ///< A beam that goes farther by this passes.
constexpr double kSamePlaceM = 0.1;      ///< Distance of two echoes of what stands,
constexpr double kSamePlacePerM = 0.01;  ///< the more by the error of the heading.
constexpr std::size_t kBeamsAside = 3;   ///< Looked at where a beam has no echo.

/// Upper limit of the width of what returned the echo, from the beams that pass on both sides of
/// it; infinity where none passes: it may go on behind what is nearer.
double widest_m(std::size_t beam, const std::vector<float>& range_m, double beam_step_rad) {
  const auto passes = [&](std::size_t other) {
    return range_m[other] > range_m[beam] + static_cast<float>(kStandsOffM);
  };
  std::size_t before = beam;
  while (before > 0 && beam - before < kBeamsAside && range_m[before - 1] <= 0.0F) --before;
  std::size_t after = beam + 1;
  while (after < range_m.size() && after - beam < kBeamsAside && range_m[after] <= 0.0F) ++after;
  if (before == 0 || after >= range_m.size() || !passes(before - 1) || !passes(after))
    return std::numeric_limits<double>::infinity();
  return static_cast<double>(after - before + 1) * std::abs(beam_step_rad) *
         static_cast<double>(range_m[beam]);
}

}  // namespace

Clutter::Earlier& Clutter::earlier_of(const std::string& scanner_id) {
  const auto found = std::ranges::find(earlier_, scanner_id, &Earlier::scanner_id);
  if (found != earlier_.end()) return *found;
  return earlier_.emplace_back(Earlier{scanner_id, {}});
}

/// True if the earlier scan has an echo near this one, at whose place there is no other one now.
bool Clutter::was_there(const Earlier& earlier, std::size_t echo, float within_m) const {
  const auto are_near = [&](const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    return (a - b).squaredNorm() <= within_m * within_m;
  };
  const auto is_of_another = [&](const Eigen::Vector2f& earlier_m) {
    for (std::size_t other = 0; other < echoes_in_odom_m_.size(); ++other)
      if (other != echo && are_near(echoes_in_odom_m_[other], earlier_m)) return true;
    return false;
  };
  return std::ranges::any_of(earlier.echoes_in_odom_m, [&](const Eigen::Vector2f& earlier_m) {
    return are_near(echoes_in_odom_m_[echo], earlier_m) && !is_of_another(earlier_m);
  });
}

void Clutter::find(const flow::SegmentedScan& scan, const std::vector<float>& range_m,
                   std::vector<char>& is_clutter) {
  is_clutter.assign(range_m.size(), 0);
  if (range_m.empty()) return;
  const Eigen::Matrix2f turn =
      geometry::rotation(scan.odom_from_base.pose.heading_rad).cast<float>();
  const Eigen::Vector2f base_m = scan.odom_from_base.pose.translation_m().cast<float>();
  Earlier& earlier = earlier_of(scan.scanner_id);
  echoes_in_odom_m_.clear();
  echoes_in_odom_m_.reserve(range_m.size());  // once for all later scans
  for (std::size_t beam = 0; beam < range_m.size(); ++beam)
    if (range_m[beam] > 0.0F)
      echoes_in_odom_m_.push_back(base_m + turn * scan.points_in_base_m[beam]);
  std::size_t echo = 0;
  for (std::size_t beam = 0; beam < range_m.size() && !earlier.echoes_in_odom_m.empty(); ++beam) {
    if (range_m[beam] <= 0.0F) continue;
    if (scan.labels[beam] == flow::PointLabel::kMoving &&
        widest_m(beam, range_m, scan.beam_step_rad) < kThinnestM) {
      const double within_m = kSamePlaceM + kSamePlacePerM * static_cast<double>(range_m[beam]);
      is_clutter[beam] = was_there(earlier, echo, static_cast<float>(within_m)) ? 0 : 1;
    }
    ++echo;
  }
  std::swap(earlier.echoes_in_odom_m, echoes_in_odom_m_);
}

}  // namespace slammot::detection
