#include "services/gateway/scan_messages.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "services/gateway/message_parts.hpp"

namespace slammot::gateway {
namespace {

using Bytes4 = std::array<std::uint8_t, 4>;

/// Colours that differ for the colour-blind too (Okabe and Ito 2008).
Bytes4 color_of(std::uint8_t label) {
  switch (label) {
    case static_cast<std::uint8_t>(flow::PointLabel::kStationary): return {86, 180, 233, 255};
    case static_cast<std::uint8_t>(flow::PointLabel::kMoving): return {230, 120, 0, 255};
    case static_cast<std::uint8_t>(flow::PointLabel::kUnknown): return {240, 228, 66, 255};
    default: return {160, 160, 160, 255};
  }
}

void add_field(const char* name, std::uint32_t offset,
               foxglove::PackedElementField::NumericType type, foxglove::PointCloud& cloud) {
  foxglove::PackedElementField& field = *cloud.add_fields();
  field.set_name(name);
  field.set_offset(offset);
  field.set_type(type);
}

void add_fields(foxglove::PointCloud& cloud) {
  using Field = foxglove::PackedElementField;
  add_field("x", 0, Field::FLOAT32, cloud);
  add_field("y", 4, Field::FLOAT32, cloud);
  add_field("red", 8, Field::UINT8, cloud);
  add_field("green", 9, Field::UINT8, cloud);
  add_field("blue", 10, Field::UINT8, cloud);
  add_field("alpha", 11, Field::UINT8, cloud);
  add_field("label", 12, Field::UINT8, cloud);
}

/// Numbers are little-endian on the wire and on every machine that this is built for.
void append_point(const Eigen::Vector2f& point, std::uint8_t label, std::string& data) {
  std::array<char, kPointStride> bytes{};
  const Bytes4 color = color_of(label);
  const float x = point.x();
  const float y = point.y();
  std::memcpy(bytes.data(), &x, 4);
  std::memcpy(bytes.data() + 4, &y, 4);
  std::memcpy(bytes.data() + 8, color.data(), 4);
  bytes[12] = static_cast<char>(label);
  data.append(bytes.data(), bytes.size());
}

}  // namespace

foxglove::LaserScan laser_scan_message(const sensing::LaserScan& scan) {
  foxglove::LaserScan message;
  set_time(scan.stamp_ns, *message.mutable_timestamp());
  message.set_frame_id(laser_frame(scan.scanner.scanner_id));
  set_pose({}, 0.0, *message.mutable_pose());
  message.set_start_angle(scan.scanner.first_beam_rad);
  if (!scan.range_m.empty())
    message.set_end_angle(sensing::beam_angle_rad(scan.scanner, scan.range_m.size() - 1));
  message.mutable_ranges()->Reserve(static_cast<int>(scan.range_m.size()));
  for (const float range_m : scan.range_m) {
    const bool is_echo = sensing::is_echo(range_m, scan.scanner.max_range_m);
    message.add_ranges(is_echo ? range_m : std::numeric_limits<double>::infinity());
  }
  return message;
}

foxglove::PointCloud labelled_points_message(const flow::LocalizedScan& scan,
                                             const std::vector<flow::PointLabel>& labels) {
  foxglove::PointCloud message;
  set_time(scan.stamp_ns, *message.mutable_timestamp());
  message.set_frame_id(kBaseFrame);
  set_pose({}, 0.0, *message.mutable_pose());
  message.set_point_stride(kPointStride);
  add_fields(message);
  std::string& data = *message.mutable_data();
  data.reserve(scan.beams.size() * kPointStride);
  for (std::size_t beam = 0; beam < scan.beams.size(); ++beam) {
    if (scan.beams[beam].range_m <= 0.0F) continue;
    const std::uint8_t label =
        beam < labels.size() ? static_cast<std::uint8_t>(labels[beam]) : kUnlabelled;
    append_point(scan.beams[beam].point_in_base_m, label, data);
  }
  return message;
}

}  // namespace slammot::gateway
