#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace slammot::files {

/// Histogram of the readings of a scanner, by centimetres and by recorded units, whatever the unit
/// is.
class ReadingHistogram {
 public:
  /// Readings of one scan, taken as metres until recount() says otherwise.
  void add(std::span<const float> readings);

  /// Counts readings in another unit by centimetres, like those in metres.
  void recount(double unit_m);

  /// Quantile of the echoes, which are nearer than the maximum range, at this share [m].
  double range_quantile_m(double max_range_m, double share) const;
  /// Quantile of the readings at this share [recorded units].
  double recorded_quantile(double share) const;
  /// Of all readings.
  double echo_share(double max_range_m) const;

  /// "No echo" is a reading that repeats at the far end of the range. Some scanners have several
  /// such codes within a percent (LMS: 81.83, 81.90, 81.91); the smallest is used. If the far end
  /// does not repeat, every reading is an echo. stated_m: maximum by the log, 0 if unknown; it
  /// holds unless the data have a code below it.
  double max_range_m(double stated_m) const;

  /// True if many different readings lie above a stated maximum: it is none. The few codes for "no
  /// echo" may lie above it.
  bool refutes(double stated_m) const;

  std::uint64_t scans_without_readings() const { return scans_without_readings_; }

 private:
  static constexpr std::size_t kBins = 65'000;    // up to 650 m
  static constexpr std::size_t kUnits = 131'072;  // 131 m in millimetres

  std::vector<std::uint32_t> count_by_cm_ = std::vector<std::uint32_t>(kBins);
  std::vector<float> smallest_by_cm_ =
      std::vector<float>(kBins, std::numeric_limits<float>::infinity());
  std::vector<std::uint32_t> count_by_unit_ = std::vector<std::uint32_t>(kUnits);
  std::uint64_t readings_ = 0;
  std::uint64_t scans_without_readings_ = 0;  ///< Only NaN, infinity or 0.
};

}  // namespace slammot::files
