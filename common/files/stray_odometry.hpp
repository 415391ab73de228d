#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "common/files/record_source.hpp"
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
class WithoutStrayOdometry : public RecordSource {
 public:
  WithoutStrayOdometry(std::unique_ptr<RecordSource> records, StrayOdometry stray)
      : records_(std::move(records)), stray_(std::move(stray)) {}

  std::optional<CarmenRecord> next() override;
  std::uint64_t line_number() const override { return records_->line_number(); }
  double fraction_read() const override { return records_->fraction_read(); }
  std::uint64_t overlong_lines() const override { return records_->overlong_lines(); }
  bool last_line_is_unfinished() const override { return records_->last_line_is_unfinished(); }
  bool is_cut() const override { return records_->is_cut(); }
  std::string damage() const override { return records_->damage(); }
  TopicChoice topics() const override { return records_->topics(); }

 private:
  bool is_stray(const OdometryRecord& record);
  void mend(LaserRecord& record);

  std::unique_ptr<RecordSource> records_;
  StrayOdometry stray_;
  std::map<StrayOdometry::Scanner, std::size_t> scans_;  ///< So far,
  std::array<std::size_t, 2> lines_{};                   ///< as are these.
};

}  // namespace slammot::files
