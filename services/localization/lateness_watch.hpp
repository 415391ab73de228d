#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/matching/timing_window.hpp"
#include "common/sensing/odometry_buffer.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/timing_scans.hpp"

namespace slammot::localization {

/// Watches on a live bus whether odometry's stamps are late or early against those of the scans:
/// pairs of scans between which speed or turn rate change are registered, at most one a scan, and
/// compared with odometry at each delay. Where a log is read, that is known before its first scan
/// (files::CarmenSurvey). Counts in scans, reads no clock, allocates nothing in steady state.
class LatenessWatch {
 public:
  /// A scan that was matched.
  struct Seen {
    std::int64_t stamp_ns = 0;
    const std::string& scanner_id;
    const geometry::Pose2& wheel_from_base;  ///< At the stamp, by the lateness in use.
    const geometry::Pose2& odom_from_base;
    const std::vector<matching::MatchPoint>& points;
  };

  explicit LatenessWatch(const LocalizerConfig& config);

  /// As it is stamped. Samples that come late are not used.
  void add(const sensing::Odometry& sample);

  /// The lateness, where it is clear that it is another than the one in use.
  std::optional<matching::OdometryTiming> observe(const Seen& seen, double in_use_s);

  /// The scans before cannot be compared with those that follow: another lateness is in use, or the
  /// vehicle was lost.
  void begin_anew() { scans_.clear(); }

  /// Pairs that were compared with odometry lately.
  const matching::TimingWindow& window() const { return window_; }

 private:
  /// A pair that was registered, until odometry has passed it at each delay.
  struct Registered {
    std::int64_t first_ns = 0;
    std::int64_t second_ns = 0;
    matching::TimedQuantity quantity;
  };
  static constexpr std::size_t kMostWaiting = 16;

  bool is_clear(const matching::TimingEvidence& found, double in_use_s) const;
  void register_next();
  bool compare_next();
  std::optional<geometry::Pose2> by_odometry(const Registered& pair, double delay_s) const;
  bool is_covered(const Registered& pair) const;

  matching::PointToLineConfig match_;
  grids::SurfelMap surfels_;  ///< Of the first scan of a pair, in its base.
  matching::PointToLineMatcher matcher_;
  sensing::OdometryBuffer odometry_;
  std::optional<std::int64_t> newest_odometry_ns_;
  std::string scanner_id_;  ///< Of the first scan: pairs are of one scanner.
  TimingScans scans_;
  std::array<Registered, kMostWaiting> waiting_;
  std::size_t first_waiting_ = 0;
  std::size_t waiting_count_ = 0;
  matching::TimingWindow window_;
  std::optional<double> last_found_s_;  ///< The filter moves about it: it makes up for what is
                                        ///< extrapolated.
};

}  // namespace slammot::localization
