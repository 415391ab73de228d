#pragma once

#include <cstddef>
#include <vector>

#include "common/flow/scan_labels.hpp"
#include "common/geometry/pose2.hpp"
#include "common/grids/evidence_grid.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/scan.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/whole_objects.hpp"

namespace slammot::localization {

/// End points of the scan at hand, and those of them that are matched against the map.
class ScanPoints {
 public:
  explicit ScanPoints(const LocalizerConfig& config) : config_(config) {}

  /// Another scan follows: the matched points become those of the scan before, and no beam is left
  /// out but those that end on companions of the vehicle (ascending).
  void begin_scan(const std::vector<std::size_t>& companion_beams = {});

  /// Takes the sweep's motion out of the points, at a constant velocity.
  void deskew(const sensing::LaserScan& scan, double speed_mps, double yaw_rate_radps);

  /// Selects what is matched: echoes in range outside of the masks, the scan seen from the pose.
  /// Masks in odom.
  void select(const sensing::LaserScan& scan, const geometry::Pose2& odom_from_base,
              const std::vector<grids::Box>& masks);

  /// From the next selection on leaves out the selected echoes that the labels, one a beam, keep
  /// out of the SO-map. False, and nothing changed, where these are left out already.
  bool leave_out(const std::vector<flow::PointLabel>& labels);

  /// One a beam.
  const std::vector<geometry::Vector2>& all_in_base_m() const { return points_in_base_m_; }
  const std::vector<matching::MatchPoint>& matched() const { return matched_; }
  const std::vector<std::size_t>& matched_beams() const { return matched_beams_; }
  /// Beams that end on what goes along with the vehicle, ascending.
  const std::vector<std::size_t>& companion_beams() const { return companion_beams_; }
  const std::vector<matching::MatchPoint>& matched_before() const { return matched_before_; }
  /// Of the matched points: matching::independent_points(), or all where no mover fills the view.
  std::size_t independent() const;
  /// Their evidence, as a share of that of a whole scan: each point is a measurement of its own, so
  /// that 20 echoes of a passing car do not outweigh odometry.
  double evidence_share() const;
  /// Where the scanner is in the base.
  const geometry::Vector2& laser_in_base_m() const { return laser_in_base_m_; }

 private:
  bool is_candidate(const sensing::LaserScan& scan, std::size_t beam) const;

  LocalizerConfig config_;
  std::vector<geometry::Vector2> points_in_base_m_;
  WholeObjects whole_objects_;
  geometry::Vector2 laser_in_base_m_ = geometry::Vector2::Zero();
  std::vector<matching::MatchPoint> matched_;
  std::vector<std::size_t> matched_beams_;
  std::vector<matching::MatchPoint> matched_before_;  ///< Of the scan before.
  std::vector<std::size_t> companion_beams_;
  std::vector<std::size_t> candidate_beams_;  ///< Whose echoes would be matched if labels left out
                                              ///< none,
  std::vector<std::size_t> left_out_beams_;   ///< and those of them that labels leave out;
                                              ///< ascending, as they are.
};

}  // namespace slammot::localization
