#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "common/files/record_filter.hpp"
#include "common/files/recorded_odometry.hpp"
#include "common/files/scanner_survey.hpp"

namespace slammot::files {

/// Poses of a log that are none of the drive's (sensing::stray_poses), by the number of their
/// record among those of its kind, from 0.
struct StrayOdometry {
  using Scanner = std::pair<LaserRecordKind, std::uint8_t>;  ///< Kind and slot.

  /// Scans, and the pose in place of the recorded one: between the nearest sound ones, as recorded.
  std::map<Scanner, std::map<std::size_t, geometry::Pose2>> scans;
  std::array<std::set<std::size_t>, 2> lines;  ///< By OdometryRecordKind; left out.

  std::size_t count() const;
};

/// Compares the poses of a kind of record with each other; poses of scans and ODOM lines that
/// agree also among each other, in the order of the log.
StrayOdometry stray_odometry_of(const std::deque<ScannerSurvey>& scanners,
                                const OdometryLinesByKind& lines);

/// Records of a log without its stray odometry.
class WithoutStrayOdometry : public RecordFilter {
 public:
  WithoutStrayOdometry(std::unique_ptr<RecordSource> records, StrayOdometry stray)
      : RecordFilter(std::move(records)), stray_(std::move(stray)) {}

  std::optional<CarmenRecord> next() override;

 private:
  bool is_stray(const OdometryRecord& record);
  void mend(LaserRecord& record);

  StrayOdometry stray_;
  std::map<StrayOdometry::Scanner, std::size_t> scans_;  ///< So far,
  std::array<std::size_t, 2> lines_{};                   ///< as are these.
};

}  // namespace slammot::files
