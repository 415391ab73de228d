#include "services/evaluator/wall_sharpness.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <variant>

#include "common/files/carmen_log.hpp"
#include "common/sensing/deskew.hpp"

namespace slammot::evaluator {
namespace {

using geometry::Pose2;
using metrics::PosePair;
using Pairs = std::vector<PosePair>;

constexpr std::int64_t kSameStampNs = 1'000'000;  // Trajectories are written with fewer digits than
                                                  // logs.
constexpr std::int64_t kLongestDifferenceNs = 200'000'000;  // Longest baseline of a velocity.

Pairs::const_iterator pair_at(const Pairs& pairs, std::int64_t stamp_ns) {
  const auto found = std::lower_bound(
      pairs.begin(), pairs.end(), stamp_ns - kSameStampNs,
      [](const PosePair& pair, std::int64_t stamp) { return pair.stamp_ns < stamp; });
  return found != pairs.end() && found->stamp_ns <= stamp_ns + kSameStampNs ? found : pairs.end();
}

/// Adds scans to a map at one of the two poses of each pair.
class Mapper {
 public:
  Mapper(Pose2 PosePair::*pose, double cell_size_m) : pose_(pose), counts_(cell_size_m) {}

  void add(const sensing::LaserScan& scan, const Pairs& pairs, Pairs::const_iterator pair,
           double longest_range_m) {
    const Pose2 map_from_base = *pair.*pose_;
    straighten(scan, pairs, pair);
    const geometry::Vector2 origin_m =
        (map_from_base * scan.scanner.base_from_laser).translation_m();
    for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
      const float range_m = scan.range_m[beam];
      const bool counts =
          sensing::is_echo(range_m, scan.scanner.max_range_m) && range_m <= longest_range_m;
      if (counts) counts_.add(origin_m, map_from_base * points_in_base_m_[beam]);
    }
  }

  metrics::MapSharpness sharpness() const { return counts_.sharpness(); }

 private:
  void straighten(const sensing::LaserScan& scan, const Pairs& pairs, Pairs::const_iterator pair) {
    const auto next = std::next(pair);
    const bool is_near =
        next != pairs.end() && next->stamp_ns - pair->stamp_ns <= kLongestDifferenceNs;
    const double duration_s =
        is_near ? static_cast<double>(next->stamp_ns - pair->stamp_ns) * 1e-9 : 1.0;
    const Pose2 step =
        is_near ? geometry::inverse(*pair.*pose_) * (*next.*pose_) : Pose2::identity();
    sensing::deskew(scan, step.x_m / duration_s, step.heading_rad / duration_s, points_in_base_m_);
  }

  Pose2 PosePair::*pose_;
  metrics::EndCounts counts_;
  std::vector<geometry::Vector2> points_in_base_m_;
};

}  // namespace

files::Result<WallSharpness> wall_sharpness(const std::filesystem::path& log, const Pairs& pairs,
                                            double sweep_s, const WallSharpnessOptions& options) {
  auto opened = files::CarmenLog::open(log);
  if (!opened) return opened.error();
  WallSharpness sharpness;
  Mapper by_estimate(&PosePair::estimate, options.cell_size_m);
  Mapper by_truth(&PosePair::truth, options.cell_size_m);
  while (auto event = opened->next()) {
    auto* const scan = std::get_if<sensing::LaserScan>(&*event);
    if (!scan) continue;
    const auto pair = pair_at(pairs, scan->stamp_ns);
    if (pair == pairs.end()) continue;
    scan->scanner.sweep_s = sweep_s;
    ++sharpness.scans;
    by_estimate.add(*scan, pairs, pair, options.longest_range_m);
    by_truth.add(*scan, pairs, pair, options.longest_range_m);
  }
  sharpness.of_estimate = by_estimate.sharpness();
  sharpness.of_truth = by_truth.sharpness();
  return sharpness;
}

}  // namespace slammot::evaluator
