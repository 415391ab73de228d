#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_buffer.hpp"
#include "common/stages/localization_stage.hpp"
#include "examples/icp_localizer/recent_map.hpp"

namespace slammot::icp_localizer {

/// Point-to-line ICP (Censi 2008) of each scan against a local map of recent scans, from the
/// prediction by odometry or constant velocity. No calibration of odometry, no relocalization, no
/// consistent covariance.
class IcpLocalizer final : public stages::LocalizationStage {
 public:
  explicit IcpLocalizer(const IcpLocalizerConfig& config) : config_(config) {}

  void add_odometry(const sensing::Odometry& sample) override;
  /// True unless later odometry could improve the prediction at the stamp.
  bool has_odometry_for(std::int64_t stamp_ns) const { return odometry_.reaches(stamp_ns); }

  std::optional<flow::LocalizedScan> localize(const sensing::LaserScan& scan,
                                              flow::LocalizedScan workspace = {}) override;
  void integrate(const flow::ScanLabels& labels) override;
  std::optional<flow::Submap> take_finished_submap() override;
  void finish() override;
  void correct(const flow::GraphCorrection& correction) override {
    map_from_odom_ = correction.map_from_odom;
  }
  std::map<std::string, std::uint64_t> named_counters() const override;

 private:
  /// Motion from the last scan to this one, in base at the last scan.
  struct Step {
    geometry::Pose2 before_from_base;
    double duration_s = 0.0;
    bool is_by_wheels = false;
  };
  /// A scan whose labels are pending.
  struct Pending {
    std::uint32_t sequence = 0;
    std::string scanner_id;
    MappedScan scan;
  };

  bool is_late(const sensing::LaserScan& scan) const;
  Step predicted_step(std::int64_t stamp_ns) const;
  std::optional<geometry::UncertainPose2> matched(const sensing::LaserScan& scan,
                                                  const geometry::UncertainPose2& predicted);
  void move_to(const geometry::UncertainPose2& odom_from_base, double duration_s);
  void begin_local_map_if_due();
  flow::LocalizedScan described(const sensing::LaserScan& scan,
                                flow::LocalizedScan localized) const;
  void add_pending(const sensing::LaserScan& scan, const flow::LocalizedScan& localized);
  void integrate_first(const std::vector<flow::PointLabel>* labels);

  IcpLocalizerConfig config_;
  sensing::OdometryBuffer odometry_;
  matching::PointToLineMatcher matcher_;
  std::optional<RecentMap> map_;             ///< Empty before the first scan.
  bool is_map_finished_ = false;             ///< The next scan begins a new local map.
  geometry::UncertainPose2 odom_from_base_;  ///< At the last scan; covariance relative to the local
                                             ///< map.
  geometry::Pose2 map_from_odom_;
  geometry::UncertainPose2 previous_from_submap_;  ///< Of the local map.
  double speed_mps_ = 0.0;
  double yaw_rate_radps_ = 0.0;
  double travelled_m_ = 0.0;
  double map_began_at_m_ = 0.0;  ///< Distance travelled before the local map.
  std::int64_t last_stamp_ns_ = 0;
  std::string last_scanner_id_;
  std::vector<geometry::Vector2> points_in_base_m_;  ///< Of the present scan, one a beam.
  std::deque<Pending> pending_;
  std::deque<flow::Submap> finished_;
  std::uint64_t scans_ = 0;
  std::uint64_t dropped_scans_ = 0;
  std::uint64_t unmatched_scans_ = 0;
};

}  // namespace slammot::icp_localizer
