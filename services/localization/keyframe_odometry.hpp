#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/fit_profile.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "common/sensing/way_ratio_filter.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// The way between two scans about a metre apart, by odometry and by one scan registered to the
/// other. The local map cannot tell odometry that is off by a constant factor: it was made by it.
/// Two scans can.
class KeyframeOdometry {
 public:
  /// A scan that was matched.
  struct Seen {
    const Step& step;
    const geometry::Pose2& odom_from_base;
    const ScanPoints& points;
    const std::string& scanner_id;
    const OdometryPrediction& prediction;  ///< Knows what to believe of odometry.
  };

  /// The scan that the next ones are compared with.
  struct Keyframe {
    std::int64_t stamp_ns = 0;
    geometry::Pose2 wheel_from_base;
    geometry::Pose2 odom_from_base;
    std::string scanner_id;
    std::vector<geometry::Vector2> points_in_base_m;
  };

  explicit KeyframeOdometry(const LocalizerConfig& config);

  /// For checkpoints.
  struct State {
    std::optional<Keyframe> keyframe;
    std::optional<std::int64_t> compared_ns;  ///< Stamp of the scan of the last comparison,
    bool is_in_doubt = true;                  ///< and whether odometry was in doubt then.
    bool rests = false;  ///< The keyframe was compared; its memory is kept for the next one.
    sensing::WayRatioFilter way_ratio;
  };
  const State& state() const { return state_; }
  void resume(State state);

  /// After each scan that was matched: where the vehicle has gone far enough since the keyframe,
  /// the comparison; this scan is then the next keyframe. None without odometry, for another
  /// scanner than the keyframe's, and where scans are rare: each is compared with the map by
  /// itself. The same scan again: the same answer.
  std::optional<sensing::OdometryComparison> observe(const Seen& seen);

 private:
  struct SinceKeyframe {
    geometry::Pose2 by_wheels;
    geometry::Pose2 expected;  ///< By the estimate.
    double duration_s = 0.0;
    bool is_still = false;
  };
  sensing::OdometryComparison compare(const Seen& seen, const SinceKeyframe& motion);
  void begin(const Seen& seen);
  void map_keyframe();
  matching::PointToLineResult registered_about(const geometry::UncertainPose2& expected,
                                               const ScanPoints& points);
  std::span<const double> fits_at(double heading_rad,
                                  std::span<const geometry::Vector2> positions_m,
                                  const ScanPoints& points);
  /// The best of registrations from several shares of the expected way, and how well the best other
  /// place fits.
  struct BestPlace {
    matching::PointToLineResult registered;
    double fit = 0.0;
    double rival_fit = 0.0;
  };
  BestPlace best_place(const geometry::UncertainPose2& prior, const ScanPoints& points);
  struct PlaceAhead {
    geometry::Pose2 pose;  ///< In the keyframe's base.
    double fit = 0.0;
    double rival_fit = 0.0;
  };
  PlaceAhead place_ahead(const geometry::Pose2& by_wheels, const ScanPoints& points);
  std::optional<geometry::UncertainPose2> registered(const geometry::Pose2& expected,
                                                     const geometry::Pose2& by_wheels,
                                                     const ScanPoints& points);
  std::optional<geometry::UncertainPose2> registered_near(const geometry::Pose2& pose,
                                                          const ScanPoints& points);
  void judge_way(const geometry::Pose2& by_wheels, const ScanPoints& points,
                 sensing::OdometryComparison& comparison);
  enum class Standing { kConfirmed, kUnclear, kRefuted };
  Standing judge_standing(const geometry::Pose2& by_wheels, const ScanPoints& points,
                          sensing::OdometryComparison& comparison);

  matching::PointToLineConfig match_;
  grids::SurfelMap surfels_;  ///< Of the keyframe, in its base.
  double nats_;               ///< Log-likelihood of a fit of 1 against one of 0.
  State state_;
  std::optional<sensing::OdometryComparison> last_;  ///< What the scan of state_.compared_ns said.
  matching::PointToLineMatcher matcher_;
  matching::FitProfile fit_profile_;
};

}  // namespace slammot::localization
