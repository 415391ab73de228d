#include "common/matching/wall_bend.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "common/geometry/order_statistics.hpp"

namespace slammot::matching {
namespace {

constexpr double kChord_m = 1.0;    // least length of a run,
constexpr double kNearest_m = 0.3;  // and range of its echoes
constexpr double kFarthest_m = 20.0;
constexpr double kNeighbours_m = 0.4;  // largest distance of neighbouring echoes of a wall
constexpr double kRun_rad = 0.35;      // of a run: over it a wall bends by a few centimetres
constexpr std::size_t kFewestEchoes = 7;
constexpr double kStraight = 0.1;  // a run that bends more than this is no wall

using Points = std::vector<Eigen::Vector2d>;

/// Sagitta over chord of a run: mean of its middle third against the line through the means of the
/// outer thirds, seen from the scanner.
double bend_of(std::span<const Eigen::Vector2d> run) {
  const std::size_t third = run.size() / 3;
  const auto mean = [](std::span<const Eigen::Vector2d> points) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& point : points) sum += point;
    return Eigen::Vector2d(sum / static_cast<double>(points.size()));
  };
  const Eigen::Vector2d first = mean(run.first(third));
  const Eigen::Vector2d last = mean(run.last(third));
  const Eigen::Vector2d middle = mean(run.subspan(third, run.size() - 2 * third));
  const Eigen::Vector2d along = last - first;
  const Eigen::Vector2d normal = Eigen::Vector2d(-along.y(), along.x()) / along.squaredNorm();
  const double towards_scanner = normal.dot(first) > 0.0 ? -1.0 : 1.0;
  return towards_scanner * normal.dot(middle - first);
}

bool is_wall(std::span<const Eigen::Vector2d> run) {
  for (std::size_t i = 1; i < run.size(); ++i)
    if ((run[i] - run[i - 1]).norm() > kNeighbours_m) return false;
  return (run.back() - run.front()).norm() >= kChord_m;
}

void add_bends(const std::vector<float>& ranges_m, double first_beam_rad, double step_rad,
               std::vector<double>& bends) {
  const auto beams =
      std::max(kFewestEchoes, static_cast<std::size_t>(std::lround(kRun_rad / step_rad)));
  Points run;
  for (std::size_t start = 0; start + beams <= ranges_m.size(); start += beams / 2) {
    run.clear();
    for (std::size_t i = start; i < start + beams; ++i) {
      const double range_m = ranges_m[i];
      if (!(range_m > kNearest_m && range_m < kFarthest_m)) break;
      const double angle_rad = first_beam_rad + static_cast<double>(i) * step_rad;
      run.emplace_back(range_m * std::cos(angle_rad), range_m * std::sin(angle_rad));
    }
    if (run.size() < beams || !is_wall(run)) continue;
    const double bend = bend_of(run);
    if (std::abs(bend) < kStraight) bends.push_back(bend);
  }
}

WallBend median_of(std::vector<double>& bends) {
  constexpr double kSigmaOfMedian = 1.4826 * 1.2533;  // of a normal distribution, times sqrt(n)
  WallBend found{
      .bend = geometry::upper_median_in_place(bends), .sigma = 0.0, .windows = bends.size()};
  for (double& bend : bends) bend = std::abs(bend - found.bend);
  if (!bends.empty())
    found.sigma = kSigmaOfMedian * geometry::upper_median_in_place(bends) /
                  std::sqrt(static_cast<double>(bends.size()));
  return found;
}

}  // namespace

WallBend wall_bend(std::span<const std::vector<float>> scans, double first_beam_rad,
                   double step_rad) {
  std::vector<double> bends;
  for (const std::vector<float>& ranges_m : scans)
    add_bends(ranges_m, first_beam_rad, step_rad, bends);
  return median_of(bends);
}

}  // namespace slammot::matching
