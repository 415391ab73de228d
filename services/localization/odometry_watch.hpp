#pragma once

#include <cstdint>
#include <optional>

#include "common/geometry/pose2.hpp"
#include "common/sensing/odometry_episodes.hpp"
#include "common/sensing/scan.hpp"
#include "services/localization/factor_watch.hpp"
#include "services/localization/keyframe_odometry.hpp"
#include "services/localization/lateness_watch.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_match.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// What only several scans tell of odometry: the way between two of them, factors of its ways and
/// turns, how late it is stamped, and in which intervals it was rejected.
class OdometryWatch {
 public:
  /// A scan after it was matched.
  struct Placed {
    const sensing::LaserScan& scan;
    const Step& step;
    const ScanMatch& match;
    const ScanPoints& points;
  };

  explicit OdometryWatch(const LocalizerConfig& config);

  void add(const sensing::Odometry& sample);

  /// The first scan of a drive.
  void begin(std::int64_t stamp_ns) { episodes_.begin(stamp_ns); }

  /// The step was predicted with the first factors; the next one will be with the others.
  void record(const Placed& placed, const sensing::WheelFactors& factors,
              const sensing::WheelFactors& next_factors);

  /// Compares ways where the match is believed, and tells the prediction. By how much the pose may
  /// be off, in odom, where odometry is found wrong now; none: nothing was compared.
  std::optional<geometry::Vector2> compare(const Placed& placed, OdometryPrediction& prediction);

  /// Odometry whose ways or turns clearly have another factor is corrected by it from the next scan
  /// on. Whether it is. After the scan was matched.
  bool rescales(const sensing::LaserScan& scan, const ScanPoints& points,
                OdometryPrediction& prediction);

  /// The same for odometry that is clearly late or early: it is read at another time.
  bool retimes(const sensing::LaserScan& scan, const ScanPoints& points, bool is_lost,
               OdometryPrediction& prediction);

  sensing::OdometryConclusions conclusions(const OdometryPrediction& prediction) const;

  const KeyframeOdometry::State& keyframes() const { return keyframes_.state(); }
  /// After a restart: a drive that goes on.
  void resume(const KeyframeOdometry::State& keyframes, std::int64_t last_stamp_ns);

 private:
  LocalizerConfig config_;
  KeyframeOdometry keyframes_;
  LatenessWatch lateness_;
  FactorWatch factors_;
  sensing::OdometryEpisodes episodes_;
};

}  // namespace slammot::localization
