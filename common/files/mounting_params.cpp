#include "common/files/mounting_params.hpp"

#include <charconv>
#include <cmath>
#include <numbers>

namespace slammot::files {

void MountingParams::Mounting::set(std::string_view what, double value) {
  if (what == "offset") offset[0] = value;
  if (what == "side_offset") offset[1] = value;
  if (what == "angular_offset") offset[2] = value;
  if (what == "up_offset") tilt.up_m = value;
  if (what == "roll_offset") tilt.roll_rad = value;
  if (what == "pitch_offset") tilt.pitch_rad = value;
}

void MountingParams::add(const ParamRecord& record) {
  constexpr std::array<std::string_view, 2> kLaser = {"robot_frontlaser_", "robot_rearlaser_"};
  constexpr std::array<std::string_view, 2> kMaxRange = {"robot_front_laser_max",
                                                         "robot_rear_laser_max"};
  constexpr std::string_view kNumbered = "robot_laser";
  constexpr double kFarthest = 100.0;
  double value = 0.0;
  const auto [end, fault] =
      std::from_chars(record.value.data(), record.value.data() + record.value.size(), value);
  if (fault != std::errc() || !(std::abs(value) < 1000.0)) return;
  for (std::size_t slot = 0; slot < named_.size(); ++slot) {
    if (record.name == kMaxRange[slot] && value > 0.0)
      named_[slot].max_range_m = static_cast<double>(static_cast<float>(value));
    if (record.name.starts_with(kLaser[slot]) && std::abs(value) < kFarthest)
      named_[slot].set(record.name.substr(kLaser[slot].size()), value);
  }
  if (!record.name.starts_with(kNumbered) || record.name.size() < kNumbered.size() + 2 ||
      !(std::abs(value) < kFarthest))
    return;
  const char digit = record.name[kNumbered.size()];
  if (digit < '1' || digit > '9' || record.name[kNumbered.size() + 1] != '_') return;
  numbered_[static_cast<std::size_t>(digit - '1')].set(record.name.substr(kNumbered.size() + 2),
                                                       value);
}

const MountingParams::Mounting* MountingParams::mounting_of(LaserRecordKind kind,
                                                            std::uint8_t slot) const {
  if (kind == LaserRecordKind::kBag || slot < 1 || slot > numbered_.size()) return nullptr;
  const Mounting& numbered = numbered_[slot - 1];
  return numbered.is_told() || slot > named_.size() ? &numbered : &named_[slot - 1];
}

std::optional<geometry::Pose2> MountingParams::base_from_laser(LaserRecordKind kind,
                                                               std::uint8_t slot) const {
  const Mounting* const mounting = mounting_of(kind, slot);
  if (mounting == nullptr || !mounting->is_told()) return std::nullopt;
  const auto& [x_m, y_m, heading_rad] = mounting->offset;
  if (mounting == &named_[1]) {
    // The rear laser looks backwards from behind the centre, whatever the sign of its recorded
    // offset.
    return geometry::Pose2{-std::abs(x_m.value_or(0.0)), y_m.value_or(0.0),
                           heading_rad.value_or(std::numbers::pi)};
  }
  return geometry::Pose2{x_m.value_or(0.0), y_m.value_or(0.0), heading_rad.value_or(0.0)};
}

sensing::Tilt MountingParams::tilt(LaserRecordKind kind, std::uint8_t slot) const {
  const Mounting* const mounting = mounting_of(kind, slot);
  return mounting == nullptr ? sensing::Tilt{} : mounting->tilt;
}

double MountingParams::max_range_m(std::uint8_t slot) const {
  return slot >= 1 && slot <= named_.size() ? named_[slot - 1].max_range_m.value_or(0.0) : 0.0;
}

}  // namespace slammot::files
