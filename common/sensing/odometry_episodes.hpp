#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/odometry_belief.hpp"

namespace slammot::sensing {

/// Type of an odometry error, inferred from odometry and scans of the same motion.
enum class OdometryFault {
  kMissing,         ///< No odometry, although there was some before.
  kJumped,          ///< One or two steps with a large error.
  kFrozen,          ///< No motion reported while the vehicle moved.
  kMovedAlone,      ///< Motion reported while the vehicle stood.
  kWrongDirection,  ///< Way with the wrong sign.
  kWrongTurn,       ///< Turn with the wrong sign.
  kSlipped,         ///< More way than the vehicle travelled.
  kShort,           ///< Less way than the vehicle travelled.
  kMisturned,       ///< Another turn than the vehicle's.
  kRough,           ///< An error of several sigmas, without bias.
};

/// One step between scans, with its diagnosis.
struct OdometryStep {
  std::int64_t stamp_ns = 0;  ///< Of the scan at the end of the step.
  double duration_s = 0.0;
  std::optional<geometry::Pose2> by_wheels = {};   ///< With the way and turn factors applied; none:
                                                   ///< no odometry.
  std::optional<geometry::Pose2> by_matches = {};  ///< None if the scan was not matched.
  StepExplanation explanation = StepExplanation::kWheels;
  bool is_jump = false;  ///< Odometry reported an impossible motion.

  bool is_believed() const {
    return by_wheels && !is_jump && explanation == StepExplanation::kWheels;
  }
};

/// An interval in which odometry was rejected. Ways are forward, turns to the left; sums over all
/// matched steps.
struct OdometryEpisode {
  OdometryFault fault = OdometryFault::kRough;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint64_t first_scan = 0;  ///< Counted from 0.
  std::uint64_t scans = 0;
  double way_by_wheels_m = 0.0;
  double way_by_matches_m = 0.0;
  double turn_by_wheels_rad = 0.0;
  double turn_by_matches_rad = 0.0;

  double duration_s() const { return static_cast<double>(end_ns - begin_ns) * 1e-9; }
};

/// Way and turn factors in use, and since when.
struct OdometryRecalibration {
  std::int64_t stamp_ns = 0;
  std::uint64_t scan = 0;
  WheelFactors factors;
};

/// State of odometry at the end of a drive, with its history.
struct OdometryConclusions {
  std::int64_t first_stamp_ns = 0;  ///< Of the drive.
  std::uint64_t steps = 0;          ///< Between scans of different stamps.
  std::uint64_t with_odometry = 0;
  std::uint64_t disbelieved = 0;  ///< Number of steps with another explanation by far better, or a
                                  ///< jump.
  WheelFactors total;           ///< Product of factors and calibration: true motion over odometry.
  double stamp_offset_s = 0.0;  ///< Lateness of odometry's stamps; 0 if uncertain.
  std::vector<OdometryRecalibration> recalibrations;
  std::vector<OdometryEpisode> episodes;  ///< In their order.
  std::uint64_t more_episodes = 0;        ///< Number of further episodes, which are not kept.
};

/// Records intervals in which odometry was rejected, in bounded memory. Call once a scan.
class OdometryEpisodes {
 public:
  static constexpr std::size_t kMostEpisodes = 50;
  static constexpr std::size_t kMostRecalibrations = 20;

  void begin(std::int64_t first_stamp_ns) { conclusions_.first_stamp_ns = first_stamp_ns; }

  /// Adds a step. A step with the same stamp as the last one replaces it: the scan was matched
  /// again. factors: used from now on.
  void observe(const OdometryStep& step, const WheelFactors& factors);

  /// Result so far; the last episode may still be open. calibration: applied in addition to the
  /// factors.
  OdometryConclusions conclusions(const MotionCalibration& calibration,
                                  double stamp_offset_s) const;

 private:
  /// Sums of way and turn.
  struct Motion {
    double way_by_wheels_m = 0.0;
    double way_by_matches_m = 0.0;
    double turn_by_wheels_rad = 0.0;
    double turn_by_matches_rad = 0.0;
  };
  /// An episode that may still grow.
  struct Open {
    OdometryEpisode episode;
    Motion since;  ///< Accepted steps after its end.
    std::uint64_t scans_since = 0;
    std::uint64_t disbelieved = 0;
    std::uint64_t missing = 0;
    std::uint64_t jumps = 0;
    bool is_more_than_rough = false;
  };

  static void add(const OdometryStep& step, Motion& motion);
  static void add(const Motion& motion, OdometryEpisode& episode);
  void take(const OdometryStep& step);
  void extend(const OdometryStep& step);
  void close();
  static std::optional<OdometryEpisode> concluded(const Open& open);

  OdometryConclusions conclusions_;
  std::optional<OdometryStep> last_;  ///< Last step, pending because it may be replaced.
  std::optional<Open> open_;
  WheelFactors factors_;
  bool had_odometry_ = false;
};

}  // namespace slammot::sensing
