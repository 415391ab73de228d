#include "common/files/scanner_survey.hpp"

#include <utility>

#include "common/files/pose_difference.hpp"

namespace slammot::files {

void RecordedMounting::add(const LaserRecord& record) {
  if (record.profile_mounting) profile_mounting = record.profile_mounting;
  if (!record.base_from_laser) return;
  if (!base_from_laser) base_from_laser = record.base_from_laser;
  is_constant = is_constant && !differ(*base_from_laser, *record.base_from_laser, 0.01, 0.01);
}

void ScannerSurvey::add(const LaserRecord& record, std::int64_t line,
                        const OdometryLinesByKind& lines, OdometryRecordKind lines_kind) {
  const std::size_t scan = scans++;
  ++scans_by_beams[record.range_m.size()];
  if (record.max_range_m > 0.0) ++scans_by_recorded_max_range[record.max_range_m];
  if (!layout) layout = record.layout;
  readings.add(record.range_m);
  mounting.add(record);
  poses.add(record.wheel_from_base);
  held_poses.add(record.wheel_from_base);
  const geometry::Pose2 recorded = poses.change
                                       ? record.wheel_from_base
                                       : lines[static_cast<std::size_t>(lines_kind)].poses.last();
  floor.add(record.range_m, recorded, own_body.add(record.range_m));
  pairs.add(record, recorded, scan);
  stamps.add(record.stamps);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines_between[i].before_scan.push_back(std::exchange(lines_between[i].since_scan, 0));
    lines_between[i].pose_before_scan.push_back(lines[i].poses.last());
  }
  ipc_clock.add(record.stamps.ipc_ns);
  logger_clock.add(record.stamps.logger_ns);
  if (record.stamps.ipc_ns) agreement.add_laser({*record.stamps.ipc_ns, record.wheel_from_base});
  agreement_by_order.add_laser({line, record.wheel_from_base});
}

matching::AssumedBeams assumed_beams_of(const ScannerSurvey& scanner, const LogPlan& plan,
                                        std::size_t beams, double fallback_field_of_view_rad) {
  const BeamLayout layout =
      scanner.layout.value_or(layout_by_convention(beams, fallback_field_of_view_rad));
  return {layout.first_beam_rad, layout.beam_step_rad, plan.base_from_laser.heading_rad,
          plan.base_from_laser.translation_m()};
}

sensing::SurveyedBeams surveyed_beams_of(const ScannerSurvey& scanner, const ScannerPlan& plan,
                                         const matching::LogCorrection& correction,
                                         double fallback_field_of_view_rad) {
  const BeamLayout layout = scanner.layout.value_or(
      layout_by_convention(scanner.floor.beams(), fallback_field_of_view_rad));
  return {.first_beam_rad = layout.first_beam_rad * correction.field_factor,
          .beam_step_rad = layout.beam_step_rad * correction.field_factor,
          .laser_heading_rad = plan.base_from_laser.heading_rad,
          .unit_m = correction.range_unit_m,
          .no_echo_m = plan.max_range_m};
}

}  // namespace slammot::files
