#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/scan_match.hpp"
#include "services/localization/submap_measurements.hpp"

namespace slammot::localization {

/// The local map, the submaps that it becomes one after the other with the constraint that ties
/// each to the one before, and where loop closing says that they lie in the map.
class SubmapSequence {
 public:
  /// Motion within the submap in progress.
  struct Travel {
    geometry::Matrix3 drift = geometry::Matrix3::Zero();  ///< Covariance of it, for the constraint
                                                          ///< to the next submap.
    double travelled_m = 0.0;
  };

  /// What a checkpoint holds beside the local map.
  struct State {
    Travel travel;
    geometry::Pose2 map_from_odom;
    std::uint32_t correction_sequence = 0;          ///< Of the newest correction.
    geometry::UncertainPose2 previous_from_submap;  ///< Of the submap in progress.
    bool is_ended = false;  ///< The submap in progress is, and the next one has not begun.
    std::int32_t short_submaps_left = 0;  ///< After the vehicle went astray.
  };

  /// help, if any, takes over part of mapping; it must outlive this.
  explicit SubmapSequence(const LocalizerConfig& config, work::SideWork* help = nullptr)
      : config_(config), help_(help) {}

  /// Before begin(): the first submap follows the last one of a stored map, tied to it by next to
  /// nothing.
  void go_on_after(const flow::CorrectedSubmap& last);

  /// The first scan, at the origin of odom.
  void begin();

  /// What comes into view is mapped with the match's error: a tie is as loose as what it inherits.
  void travel(const geometry::Pose2& before_from_base, const ScanMatch& match);

  /// The motion within the submap may be off by up to this much, in odom: evenly distributed.
  void doubt(const geometry::Vector2& up_to_m);

  /// Ends the submap in progress where the vehicle has outgrown it, and begins the next one.
  /// Whether one was ended.
  bool begin_next_if_due(const geometry::Pose2& odom_from_base);

  /// Begins an empty submap at the pose, tied to the one before by next to nothing. The vehicle has
  /// not been in that one since since_ns. Whether one was ended.
  bool begin_astray(const geometry::Pose2& odom_from_base, std::int64_t since_ns);

  /// Ends the submap in progress if it holds anything, as at the end of a drive. Whether it did.
  bool finish(const geometry::Pose2& odom_from_base);

  /// Submap that was finished since the last call.
  std::optional<flow::Submap> take_finished();

  /// Older corrections than the newest are ignored.
  void correct(const flow::GraphCorrection& correction);

  /// Fixes and compass readings that the submap in progress will carry.
  SubmapMeasurements& measurements() { return measurements_; }

  LocalMap& map() { return map_; }
  const LocalMap& map() const { return map_; }
  work::SideWork* help() const { return help_; }
  const geometry::Pose2& map_from_odom() const { return state_.map_from_odom; }

  const State& state() const { return state_; }
  const Travel& travelled() const { return state_.travel; }
  /// Undoes travel() since.
  void set_travelled(const Travel& travel) { state_.travel = travel; }

  /// After a restart: goes on from the state and the map of a checkpoint.
  void resume(const State& state, LocalMap map);

 private:
  void end(const geometry::Pose2& odom_from_base);
  void begin_with(const geometry::UncertainPose2& previous_from_submap);

  LocalizerConfig config_;
  work::SideWork* help_;
  LocalMap map_;
  flow::SubmapId first_submap_;
  State state_;
  SubmapMeasurements measurements_;
  std::vector<flow::Submap> finished_;
};

}  // namespace slammot::localization
