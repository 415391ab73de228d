#include "common/files/bag_scan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/files/text.hpp"

namespace slammot::files {
namespace {

constexpr double kPi = std::numbers::pi;

/// Largest rounding error of float32.
double float_error(double value) {
  return 0.5000001 * std::abs(value) * static_cast<double>(std::numeric_limits<float>::epsilon());
}

std::optional<double> nearest_decimal(double value, int decimals, double error) {
  constexpr std::array<double, 13> kPowerOfTen{1e0, 1e1, 1e2, 1e3,  1e4,  1e5, 1e6,
                                               1e7, 1e8, 1e9, 1e10, 1e11, 1e12};
  const double scale = kPowerOfTen[static_cast<std::size_t>(decimals)];
  const double decimal = std::round(value * scale) / scale;
  return std::abs(decimal - value) <= error ? std::optional(decimal) : std::nullopt;
}

std::optional<double> few_decimals(double value, int most_decimals, double error) {
  for (int decimals = 0; decimals <= most_decimals; ++decimals) {
    if (const auto decimal = nearest_decimal(value, decimals, error)) return decimal;
  }
  return std::nullopt;
}

/// Steps that divide a half turn: 1, 0.5, 0.25, 1/3 degrees are 180, 360, 720, 540.
std::optional<double> step_by_count(double step_rad) {
  const double count = std::round(kPi / std::abs(step_rad));
  if (!(count >= 2.0 && count <= 1e5)) return std::nullopt;
  const double step = kPi / count;
  return std::abs(step - std::abs(step_rad)) <= float_error(step_rad)
             ? std::optional(std::copysign(step, step_rad))
             : std::nullopt;
}

/// Multiples of 0.125 or 0.1 degrees.
std::optional<double> simple_degrees(double angle_rad) {
  const double degrees = angle_rad * 180.0 / kPi;
  for (const double parts : {8.0, 10.0}) {
    const double angle = kPi * (std::round(degrees * parts) / parts / 180.0);
    if (std::abs(angle - angle_rad) <= float_error(angle_rad)) return angle;
  }
  return std::nullopt;
}

double six_decimals(double value) { return std::round(value * 1e6) / 1e6; }

/// CARMEN writes six decimals: data converted from such text have -1.570796 for -pi/2, and 0.008727
/// for pi/360. If first beam and step are of that kind, the layout is that of ROBOTLASER1.
std::optional<BeamLayout> layout_of_text(double first_beam_rad, double step_rad,
                                         std::size_t beams) {
  const double degrees = std::round(first_beam_rad * 180.0 / kPi * 8.0) / 8.0;
  const double first_rad = six_decimals(kPi * (degrees / 180.0));
  if (std::abs(first_rad - first_beam_rad) > float_error(first_beam_rad) ||
      simple_degrees(first_beam_rad))
    return std::nullopt;
  const double count = std::round(kPi / step_rad);
  const double meant_rad = kPi / count;
  const bool is_meant = std::abs(meant_rad - step_rad) <= float_error(step_rad) ||
                        std::abs(six_decimals(meant_rad) - step_rad) <= float_error(step_rad);
  if (!(count >= 2.0 && count <= 1e4) || !is_meant) return std::nullopt;
  const double steps = static_cast<double>(beams - 1);
  return BeamLayout{first_rad, six_decimals(steps * meant_rad) / steps};
}

/// The step with the sign of last - first beam, where their distance agrees with its size: some
/// drivers have the sign wrong.
float signed_step_rad(float first_beam_rad, float last_beam_rad, float beam_step_rad,
                      std::size_t beams) {
  constexpr float kAgrees = 0.03F;
  const float by_ends_rad = (last_beam_rad - first_beam_rad) / static_cast<float>(beams - 1);
  const float size_rad = std::abs(beam_step_rad);
  const bool agrees = std::abs(std::abs(by_ends_rad) - size_rad) <= kAgrees * size_rad;
  return agrees ? std::copysign(beam_step_rad, by_ends_rad) : beam_step_rad;
}

double angle_as_meant(float angle_rad) {
  const auto angle = static_cast<double>(angle_rad);
  if (const auto degrees = simple_degrees(angle)) return *degrees;
  return few_decimals(angle, 6, float_error(angle)).value_or(angle);
}

}  // namespace

double heading_as_written(double heading_rad) {
  constexpr double kError = 4e-15;
  constexpr int kTurns = 16;
  if (const auto decimal = few_decimals(heading_rad, 9, kError)) return *decimal;
  for (int turns = 1; turns <= kTurns; ++turns) {
    for (const double sign : {1.0, -1.0}) {
      const double unwrapped_rad = heading_rad + sign * 2.0 * kPi * turns;
      if (const auto decimal = nearest_decimal(unwrapped_rad, 6, kError * (1.0 + turns)))
        return geometry::wrap_angle(*decimal);
    }
  }
  return heading_rad;
}

geometry::Pose2 planar(const bags::Transform& parent_from_child) {
  const Eigen::Quaterniond& q = parent_from_child.rotation;
  const bool is_about_z = q.x() == 0.0 && q.y() == 0.0;
  const double heading_rad =
      is_about_z ? 2.0 * std::atan2(q.z(), q.w())
                 : std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                              q.w() * q.w() + q.x() * q.x() - q.y() * q.y() - q.z() * q.z());
  return {parent_from_child.translation_m.x(), parent_from_child.translation_m.y(),
          geometry::wrap_angle(heading_as_written(geometry::wrap_angle(heading_rad)))};
}

Mounting mounting_of(const bags::Transform& base_from_laser) {
  const Eigen::Vector3d up = base_from_laser.rotation.normalized() * Eigen::Vector3d::UnitZ();
  return {planar(base_from_laser), up.z() < 0.0, std::acos(std::min(1.0, std::abs(up.z())))};
}

sensing::SpatialMounting in_space(const bags::Transform& base_from_laser) {
  return {base_from_laser.translation_m, base_from_laser.rotation.normalized().toRotationMatrix()};
}

std::optional<BeamLayout> layout_of_message(float first_beam_rad, float last_beam_rad,
                                            float stated_step_rad, std::size_t beams) {
  if (!std::isfinite(first_beam_rad) || !std::isfinite(stated_step_rad) || beams < 2 ||
      std::abs(first_beam_rad) > 7.0F)
    return std::nullopt;
  const float beam_step_rad =
      signed_step_rad(first_beam_rad, last_beam_rad, stated_step_rad, beams);
  const double first_rad = angle_as_meant(first_beam_rad);
  const double last_rad = std::isfinite(last_beam_rad) && std::abs(last_beam_rad) < 14.0F
                              ? angle_as_meant(last_beam_rad)
                              : first_rad;
  const double sign =
      beam_step_rad < 0.0F || (beam_step_rad == 0.0F && last_rad < first_rad) ? -1.0 : 1.0;
  if (beam_step_rad != 0.0F) {
    const auto step_rad = step_by_count(static_cast<double>(beam_step_rad));
    constexpr double kMostRad = 2.0 * kPi * 1.01;
    if (std::abs(beam_step_rad) * static_cast<double>(beams - 1) > kMostRad) return std::nullopt;
    const auto of_text = sign > 0.0 ? layout_of_text(static_cast<double>(first_beam_rad),
                                                     static_cast<double>(beam_step_rad), beams)
                                    : std::nullopt;
    if (of_text) return of_text;
    if (step_rad) return BeamLayout{first_rad, *step_rad};
  }
  const double step_rad = std::abs(angle_as_meant(beam_step_rad));
  double field_rad = sign * (last_rad - first_rad);
  field_rad = few_decimals(field_rad, 9, 4e-15).value_or(field_rad);
  if (field_rad <= 0.0)
    return step_rad > 0.0 ? std::optional(BeamLayout{first_rad, sign * step_rad}) : std::nullopt;
  auto layout = layout_of_record(sign * first_rad, field_rad, step_rad, beams);
  if (!layout) return std::nullopt;
  return BeamLayout{first_rad, sign * layout->beam_step_rad};
}

std::optional<LaserRecord> record_of(const bags::LaserScanMessage& scan) {
  if (scan.range_m.size() < 2 || scan.range_m.size() > kMaxBeams) return std::nullopt;
  LaserRecord record;
  record.kind = LaserRecordKind::kBag;
  record.layout = layout_of_message(scan.first_beam_rad, scan.last_beam_rad, scan.beam_step_rad,
                                    scan.range_m.size());
  if (!record.layout) return std::nullopt;
  record.max_range_m = std::isfinite(scan.most_range_m) && scan.most_range_m > 0.0F
                           ? static_cast<double>(scan.most_range_m)
                           : 0.0;
  record.range_m = scan.range_m;
  if (scan.least_range_m > 0.0F && scan.least_range_m < scan.most_range_m) {
    for (float& range_m : record.range_m) {
      if (range_m < scan.least_range_m) range_m = 0.0F;
    }
  }
  return record;
}

std::string why_no_record(const bags::LaserScanMessage& scan) {
  if (scan.range_m.size() < 2 || scan.range_m.size() > kMaxBeams)
    return "it has " + std::to_string(scan.range_m.size()) + " ranges";
  const bool may_be_degrees = std::abs(scan.first_beam_rad) > 7.0F;
  return text(
      "its angles are impossible%s (angle_min %g, angle_max %g, angle_increment %g rad, "
      "%zu ranges)",
      may_be_degrees ? ", perhaps degrees" : "", static_cast<double>(scan.first_beam_rad),
      static_cast<double>(scan.last_beam_rad), static_cast<double>(scan.beam_step_rad),
      scan.range_m.size());
}

LaserRecord record_of(const bags::PointCloudMessage& cloud, const bags::Transform& base_from_cloud,
                      const CloudSlice& slice) {
  LaserRecord record;
  record.kind = LaserRecordKind::kBag;
  const double step_rad = 2.0 * kPi / static_cast<double>(slice.beams);
  record.layout = BeamLayout{-kPi + 0.5 * step_rad, step_rad};
  record.base_from_laser =
      geometry::Pose2{base_from_cloud.translation_m.x(), base_from_cloud.translation_m.y(), 0.0};
  record.range_m.assign(slice.beams, 0.0F);
  const Eigen::Matrix3d rotation = base_from_cloud.rotation.normalized().toRotationMatrix();
  for (const Eigen::Vector3f& point_in_cloud : cloud.points_m) {
    const Eigen::Vector3d from_sensor = rotation * point_in_cloud.cast<double>();
    const double height_m = from_sensor.z() + base_from_cloud.translation_m.z();
    const double range_m = from_sensor.head<2>().norm();
    if (!(height_m >= slice.from_m && height_m <= slice.to_m) || !(range_m > 0.0 && range_m < 1e4))
      continue;
    const double turned = (std::atan2(from_sensor.y(), from_sensor.x()) + kPi) / step_rad;
    float& nearest_m =
        record.range_m[std::min(slice.beams - 1, static_cast<std::size_t>(std::max(0.0, turned)))];
    if (nearest_m == 0.0F || static_cast<float>(range_m) < nearest_m)
      nearest_m = static_cast<float>(range_m);
  }
  return record;
}

}  // namespace slammot::files
