#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/sensing/odometry_belief.hpp"

namespace slammot::sensing {

/// How odometry was wrong for a while, by what it and the scans say of the same motion.
enum class OdometryFault {
  kMissing,          ///< No odometry, though there was some before.
  kJumped,           ///< One or two steps that are far off.
  kFrozen,           ///< No motion while the vehicle moved.
  kMovedAlone,       ///< Motion while the vehicle stood.
  kWrongDirection,   ///< Way with the wrong sign.
  kWrongTurn,        ///< Turn with the wrong sign.
  kSlipped,          ///< More way than the vehicle went.
  kShort,            ///< Less way than the vehicle went.
  kMisturned,        ///< Another turn than the vehicle made.
  kRough,            ///< Several sigmas off, without a bias.
};

/// One step from scan to scan, with what was concluded of it.
struct OdometryStep {
  std::int64_t stamp_ns = 0;                       ///< Of the scan that ends it.
  double duration_s = 0.0;
  std::optional<geometry::Pose2> by_wheels;        ///< With the way and turn factors applied; none: odometry said nothing.
  std::optional<geometry::Pose2> by_matches;       ///< None where the scan was not matched.
  StepExplanation explanation = StepExplanation::kWheels;
  bool is_jump = false;                            ///< Odometry reported what cannot be.

  bool is_believed() const { return by_wheels && !is_jump && explanation == StepExplanation::kWheels; }
};

/// A while in which odometry was not believed. Ways are forward, turns to the left; sums over all its steps that were matched.
struct OdometryEpisode {
  OdometryFault fault = OdometryFault::kRough;
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::uint64_t first_scan = 0;                    ///< Counted from 0.
  std::uint64_t scans = 0;
  double way_by_wheels_m = 0.0;
  double way_by_matches_m = 0.0;
  double turn_by_wheels_rad = 0.0;
  double turn_by_matches_rad = 0.0;

  double duration_s() const { return static_cast<double>(end_ns - begin_ns) * 1e-9; }
};

/// Way and turn factors that came to be applied, and since when.
struct OdometryRecalibration {
  std::int64_t stamp_ns = 0;
  std::uint64_t scan = 0;
  WheelFactors factors;
};

/// What is believed of odometry at the end of a drive, and what was concluded on the way.
struct OdometryConclusions {
  std::int64_t first_stamp_ns = 0;                 ///< Of the drive.
  std::uint64_t steps = 0;                         ///< Between scans of different stamps.
  std::uint64_t with_odometry = 0;
  std::uint64_t disbelieved = 0;                   ///< Of these: another explanation was better by far, or it was a jump.
  WheelFactors total;                              ///< Factors and calibration together: what is true by what odometry says.
  double stamp_offset_s = 0.0;                     ///< By how much later than the scans it is stamped; 0 where that is not certain.
  std::vector<OdometryRecalibration> recalibrations;
  std::vector<OdometryEpisode> episodes;           ///< In their order.
  std::uint64_t more_episodes = 0;                 ///< Not kept, beyond the first ones.
};

/// Records episodes in which odometry was not believed, in bounded memory. One call a scan.
class OdometryEpisodes {
 public:
  static constexpr std::size_t kMostEpisodes = 50;
  static constexpr std::size_t kMostRecalibrations = 20;

  void begin(std::int64_t first_stamp_ns) { conclusions_.first_stamp_ns = first_stamp_ns; }

  /// A step that ends at the same stamp as the last one replaces it: the scan was matched again. factors: applied from now on.
  void observe(const OdometryStep& step, const WheelFactors& factors);

  /// So far; the episode that still lasts is the last one. calibration: of the estimate, in addition to the factors.
  OdometryConclusions conclusions(const MotionCalibration& calibration, double stamp_offset_s) const;

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
    Motion since;                 ///< Steps that were believed, after its end.
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
  std::optional<OdometryStep> last_;   ///< Not yet taken: it may be replaced.
  std::optional<Open> open_;
  WheelFactors factors_;
  bool had_odometry_ = false;
};

}  // namespace slammot::sensing
