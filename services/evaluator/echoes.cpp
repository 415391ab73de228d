#include "services/evaluator/echoes.hpp"

#include <utility>
#include <variant>

#include "common/files/carmen_log.hpp"
#include "common/sensing/deskew.hpp"

namespace slammot::evaluator {
namespace {

constexpr std::int64_t kLongestTruthGapNs = 200'000'000;
constexpr double kDifferenceS = 0.05;  // Baseline of the true velocity.

struct Motion {
  geometry::Pose2 world_from_base;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
};

std::optional<Motion> true_motion(const metrics::Trajectory& truth, std::int64_t stamp_ns) {
  const auto now = metrics::pose_at(truth, stamp_ns, kLongestTruthGapNs);
  if (!now) return std::nullopt;
  const auto later = metrics::pose_at(
      truth, stamp_ns + static_cast<std::int64_t>(kDifferenceS * 1e9), kLongestTruthGapNs);
  if (!later) return Motion{*now};
  const geometry::Pose2 moved = geometry::inverse(*now) * *later;
  return Motion{*now, moved.x_m / kDifferenceS, moved.heading_rad / kDifferenceS};
}

EchoesInWorld echoes_of(const sensing::LaserScan& scan, const Motion& motion,
                        std::vector<geometry::Vector2>& points_in_base_m) {
  sensing::deskew(scan, motion.speed_mps, motion.yaw_rate_radps, points_in_base_m);
  EchoesInWorld echoes{scan.stamp_ns, {}};
  echoes.points_m.resize(scan.range_m.size());
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    if (sensing::is_echo(scan.range_m[beam], scan.scanner.max_range_m))
      echoes.points_m[beam] = motion.world_from_base * points_in_base_m[beam];
  }
  return echoes;
}

}  // namespace

std::optional<files::Error> read_echoes(const std::filesystem::path& log,
                                        const metrics::Trajectory& truth, double sweep_s,
                                        const std::function<void(const EchoesInWorld&)>& take) {
  auto opened = files::CarmenLog::open(log);
  if (!opened) return opened.error();
  std::vector<geometry::Vector2> points_in_base_m;
  while (auto event = opened->next()) {
    auto* const scan = std::get_if<sensing::LaserScan>(&*event);
    if (!scan) continue;
    scan->scanner.sweep_s = sweep_s;
    if (const auto motion = true_motion(truth, scan->stamp_ns))
      take(echoes_of(*scan, *motion, points_in_base_m));
  }
  return std::nullopt;
}

}  // namespace slammot::evaluator
