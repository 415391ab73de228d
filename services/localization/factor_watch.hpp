#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/matching/correlative.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_belief.hpp"

namespace slammot::localization {

/// Ratios of a quantity by scans to the same by odometry, over pairs of scans.
class FactorRatios {
 public:
  /// Ignored once enough is known.
  void add(double by_scans_over_by_odometry);

  /// The median, where it is clear that it is another than the one in use.
  std::optional<double> other_than(double in_use) const;

  /// To be told after each pair. What is known once is not looked at again: another factor later is
  /// none that was there from the start, and the filter's to find.
  void settle(double in_use);
  bool is_settled() const { return is_settled_; }

  std::size_t size() const { return count_; }

 private:
  static constexpr std::size_t kMost = 32;

  struct Spread {
    double median = 1.0;
    double sigma = 0.0;  ///< Of the median, by the median absolute deviation.
  };
  Spread spread() const;

  std::array<double, kMost> ratios_{};
  std::size_t count_ = 0;
  bool is_settled_ = false;
};

/// Finds factors of odometry's ways and turns that are wrong from the start of a drive on a live
/// bus. Scans a metre or 0.15 rad apart by odometry are matched by correlation, wherever
/// odometry or the estimate has them: the map cannot tell, since it was made with the factors.
/// Ends once both are known, or after 200 pairs, so that it costs nothing later. Where a log is
/// read, they are known before its first scan (matching::weigh_log). Not in a checkpoint: after a
/// restart it looks again. Reads no clock.
class FactorWatch {
 public:
  /// A scan that was matched.
  struct Seen {
    const std::string& scanner_id;
    const geometry::Pose2& wheel_from_base;  ///< As odometry has it, without factors.
    const std::vector<matching::MatchPoint>& points;
  };

  FactorWatch();

  /// The factors, where it is clear that they are others than those in use.
  std::optional<sensing::WheelFactors> observe(const Seen& seen,
                                               const sensing::WheelFactors& in_use);

  /// The scan before cannot be compared with those that follow.
  void begin_anew() { has_first_ = false; }

  bool has_ended() const;

  std::size_t ways() const { return ways_.size(); }
  std::size_t turns() const { return turns_.size(); }

 private:
  using Points = std::vector<Eigen::Vector2f>;

  void begin(const Seen& seen);
  bool tells(const geometry::Pose2& by_wheels) const;
  void compare(const geometry::Pose2& by_wheels, const Points& second);

  matching::CorrelativeMatcher matcher_;
  std::string scanner_id_;  ///< Of the first scan: pairs are of one scanner.
  bool has_first_ = false;
  geometry::Pose2 first_wheel_from_base_;
  Points first_;  ///< In its base.
  FactorRatios ways_;
  FactorRatios turns_;
  std::size_t pairs_ = 0;  ///< Compared.
};

}  // namespace slammot::localization
