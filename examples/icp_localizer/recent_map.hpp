#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "common/flow/localized_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/grids/evidence_grid.hpp"
#include "common/grids/surfel_map.hpp"
#include "examples/icp_localizer/icp_localizer_config.hpp"

namespace slammot::icp_localizer {

/// One scan as the map takes it: rays in odom, in the order of the beams.
struct MappedScan {
  std::int64_t stamp_ns = 0;
  geometry::Vector2 laser_in_odom_m = geometry::Vector2::Zero();
  std::vector<grids::Ray> rays;
  double beam_step_rad = 0.0;
  double travelled_m = 0.0;  ///< Of the vehicle, since the drive's first scan.
};

/// Local map of the recent scans, in odom: surfels to match against, SO-map and MO-map to tell what
/// moves. Each local map becomes one submap; the next one begins with the last few scans, so that
/// matching and detection have something to compare with.
class RecentMap {
 public:
  RecentMap(const IcpLocalizerConfig& config, flow::SubmapId id,
            const geometry::Vector2& centre_in_odom_m);

  void add(const MappedScan& scan);

  /// The next local map, around the place, with the last scans of this one.
  RecentMap next(const geometry::Vector2& centre_in_odom_m) const;

  /// What the map says about the cell in which the beam ended.
  void look_up_end(const geometry::Vector2& end_in_odom_m, flow::LocalizedBeam& beam) const;

  /// From the laser to the first occupied cell in the direction (unit vector), or max_range_m.
  double expected_range_m(const geometry::Vector2& laser_in_odom_m,
                          const geometry::Vector2& direction, double max_range_m) const {
    return evidence_.distance_to_occupied(laser_in_odom_m, direction, max_range_m);
  }

  const grids::SurfelMap& surfels() const { return surfels_; }
  flow::SubmapId id() const { return id_; }
  const geometry::Pose2& odom_from_submap() const { return odom_from_submap_; }
  bool has_scans() const { return scans_ > 0; }

  /// Grids and surfels as a submap. Constraint and travel are the caller's to fill in.
  flow::Submap submap() const;

 private:
  void integrate(const MappedScan& scan);

  IcpLocalizerConfig config_;
  flow::SubmapId id_;
  geometry::Pose2 odom_from_submap_;
  grids::EvidenceGrid evidence_;
  grids::SurfelMap surfels_;
  std::deque<MappedScan> last_scans_;  ///< Some distance apart.
  std::uint64_t scans_ = 0;            ///< Without those that it began with.
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace slammot::icp_localizer
