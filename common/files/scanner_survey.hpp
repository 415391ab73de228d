#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/files/carmen_record.hpp"
#include "common/files/clock_check.hpp"
#include "common/files/odometry_agreement.hpp"
#include "common/files/pair_sample.hpp"
#include "common/files/reading_histogram.hpp"
#include "common/files/recorded_odometry.hpp"
#include "common/sensing/floor_survey.hpp"
#include "common/sensing/odometry_sampling.hpp"
#include "common/sensing/own_body.hpp"

namespace slammot::files {

/// Mounting of a scanner by its records.
struct RecordedMounting {
  std::optional<geometry::Pose2> base_from_laser;            ///< Of the first record.
  bool is_constant = true;                                   ///< base_from_laser of all records.
  std::optional<sensing::SpatialMounting> profile_mounting;  ///< Of bags.

  void add(const LaserRecord& record);
  /// nullopt if it is not recorded, or changes.
  std::optional<geometry::Pose2> constant() const {
    return is_constant ? base_from_laser : std::nullopt;
  }
};

/// Statistics of one kind of laser record of one scanner.
struct ScannerSurvey {
  LaserRecordKind kind = LaserRecordKind::kFlaser;
  std::uint8_t slot = 1;
  std::string scanner;
  std::uint64_t scans = 0;
  std::map<std::size_t, std::uint64_t> scans_by_beams;
  std::map<double, std::uint64_t> scans_by_recorded_max_range;
  std::optional<BeamLayout> layout;  ///< Of the first record that has one.
  RecordedMounting mounting;
  ReadingHistogram readings;
  RecordedStamps stamps;
  ClockCheck ipc_clock;
  ClockCheck logger_clock;
  RecordedPoses poses;
  sensing::HeldPoses held_poses;
  std::array<LinesBetween, 2> lines_between;  ///< By OdometryRecordKind.
  OdometryAgreement agreement;                ///< By ipc time.
  OdometryAgreement agreement_by_order;       ///< By the lines' order in the log.
  sensing::OwnBodySurvey own_body;
  sensing::FloorSurvey floor;
  ScanPairSurvey pairs;

  /// line: number of the record in the log. kind: which lines count as odometry where the poses of
  /// the records are constant.
  void add(const LaserRecord& record, std::int64_t line, const OdometryLinesByKind& lines,
           OdometryRecordKind lines_kind);
};

/// Of scans with so many beams. fallback_field_of_view_rad: from the first to the last beam, for
/// records without a layout.
matching::AssumedBeams assumed_beams_of(const ScannerSurvey& scanner, const LogPlan& plan,
                                        std::size_t beams, double fallback_field_of_view_rad);

/// Of the scans in which the floor is looked for, by the corrections of unit and field of view.
sensing::SurveyedBeams surveyed_beams_of(const ScannerSurvey& scanner, const ScannerPlan& plan,
                                         const matching::LogCorrection& correction,
                                         double fallback_field_of_view_rad);

}  // namespace slammot::files
