#include "services/localization/map_agreement.hpp"

#include <cmath>

namespace slammot::localization {
namespace {

constexpr std::size_t kPointsPerProbe = 4;  // neighbours end on the same thing
constexpr int kFewestProbes = 10;
constexpr double kThroughAWall_m = 1.0;  // grazing beams meet the cells before the one that they
                                         // end in

int tolerance_in_cells(const LocalMapConfig& config) {
  return static_cast<int>(std::ceil(config.end_cell_tolerance_m / config.cell_size_m - 0.5));
}

}  // namespace

double MapAgreement::share_of_known(int points) const {
  const int known = behind_walls + in_free_space + explained;
  return known < kFewestProbes ? 0.0 : static_cast<double>(points) / known;
}

MapAgreement agreement(const ScanPoints& points, const geometry::Pose2& odom_from_base,
                       const grids::EvidenceGrid& evidence, const LocalMapConfig& config) {
  const int free_steps = grids::steps_of_log_odds(config.free_log_odds);
  const int tolerance = tolerance_in_cells(config);
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  const geometry::Vector2 origin_m = odom_from_base * points.laser_in_base_m();
  MapAgreement found;
  for (std::size_t i = 0; i < points.matched().size(); i += kPointsPerProbe) {
    const geometry::Vector2 at_m =
        odom_from_base.translation_m() + turn * points.matched()[i].in_base_m;
    const grids::Cell cell = evidence.window().cell_at(at_m.x(), at_m.y());
    const double range_m = (at_m - origin_m).norm();
    const bool is_behind_a_wall =
        range_m > kThroughAWall_m &&
        evidence.distance_to_occupied(origin_m, (at_m - origin_m) / range_m, range_m) <
            range_m - kThroughAWall_m;
    const bool is_explained = evidence.is_occupied_near(cell, tolerance);
    if (is_behind_a_wall) ++found.behind_walls;
    else if (!is_explained && evidence.so_steps(cell) <= -free_steps) ++found.in_free_space;
    else if (is_explained) ++found.explained;
  }
  return found;
}

double fit_at(double matched_share, const ScanPoints& points, const geometry::Pose2& odom_from_base,
              const LocalMap& map, const LocalMapConfig& config) {
  return matched_share -
         agreement(points, odom_from_base, map.evidence(), config).contradicting_share();
}

double explained_share(const std::vector<matching::MatchPoint>& points,
                       const geometry::Pose2& odom_from_base, const grids::EvidenceGrid& evidence,
                       const LocalMapConfig& config) {
  const int tolerance = tolerance_in_cells(config);
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  int explained = 0;
  int probes = 0;
  for (std::size_t i = 0; i < points.size(); i += kPointsPerProbe, ++probes) {
    const geometry::Vector2 at_m = odom_from_base.translation_m() + turn * points[i].in_base_m;
    if (evidence.is_occupied_near(evidence.window().cell_at(at_m.x(), at_m.y()), tolerance))
      ++explained;
  }
  return probes == 0 ? 0.0 : static_cast<double>(explained) / probes;
}

}  // namespace slammot::localization
