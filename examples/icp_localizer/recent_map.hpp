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

/// A scan to be mapped: rays in odom, in the order of beams.
struct MappedScan {
  std::int64_t stamp_ns = 0;
  geometry::Vector2 laser_in_odom_m = geometry::Vector2::Zero();
  std::vector<grids::Ray> rays;
  double beam_step_rad = 0.0;
  double travelled_m = 0.0;  ///< Of the vehicle, since the drive's first scan.
};

/// Local map of recent scans in odom: surfels for matching; SO-map and MO-map for detection. Each
/// local map becomes a submap. The next one begins with the last few scans, so that matching and
/// detection have a reference.
class RecentMap {
 public:
  RecentMap(const IcpLocalizerConfig& config, flow::SubmapId id,
            const geometry::Vector2& centre_in_odom_m);

  void add(const MappedScan& scan);

  /// The next local map, with the given centre and the last scans of this one.
  RecentMap next(const geometry::Vector2& centre_in_odom_m) const;

  /// Sets the beam's state of the cell in which it ended.
  void look_up_end(const geometry::Vector2& end_in_odom_m, flow::LocalizedBeam& beam) const;

  /// Range to the first occupied cell along the direction (unit vector), or max_range_m.
  double expected_range_m(const geometry::Vector2& laser_in_odom_m,
                          const geometry::Vector2& direction, double max_range_m) const {
    return evidence_.distance_to_occupied(laser_in_odom_m, direction, max_range_m);
  }

  const grids::SurfelMap& surfels() const { return surfels_; }
  flow::SubmapId id() const { return id_; }
  const geometry::Pose2& odom_from_submap() const { return odom_from_submap_; }
  bool has_scans() const { return scans_ > 0; }

  /// Grids and surfels as a submap. The caller sets constraint and travelled distance.
  flow::Submap submap() const;

 private:
  void integrate(const MappedScan& scan);

  IcpLocalizerConfig config_;
  flow::SubmapId id_;
  geometry::Pose2 odom_from_submap_;
  grids::EvidenceGrid evidence_;
  grids::SurfelMap surfels_;
  std::deque<MappedScan> last_scans_;  ///< At some distance from each other.
  std::uint64_t scans_ = 0;            ///< Without the initial ones.
  std::int64_t first_stamp_ns_ = 0;
  std::int64_t last_stamp_ns_ = 0;
};

}  // namespace slammot::icp_localizer
