#pragma once

#include <string>
#include <string_view>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

/// What localized and segmented scans begin with, the same members in both; not for use outside
/// this folder.
namespace slammot::wire {

template <typename Sample, typename Scan>
void encode_scan_header(std::string_view vehicle_id, const Scan& scan, Sample& sample) {
  set_text(sample.vehicle_id, vehicle_id);
  set_text(sample.scanner_id, scan.scanner_id);
  sample.stamp_ns = scan.stamp_ns;
  sample.sequence_number = scan.sequence;
  sample.base_from_laser = encode(scan.base_from_laser);
  sample.max_range_m = scan.max_range_m;
  sample.beam_step_rad = scan.beam_step_rad;
  sample.sweep_s = scan.sweep_s;
  sample.odom_from_base = encode(scan.odom_from_base);
  sample.map_from_odom = encode(scan.map_from_odom);
  sample.map_id = scan.map_id.value;
  sample.odom_id = scan.odom_id.value;
}

template <typename Sample>
std::string_view fault_of_scan_header(const Sample& sample) {
  if (!is_sound(sample.base_from_laser)) return "base_from_laser is not finite";
  if (!is_amount(sample.max_range_m)) return "max_range_m is negative or not finite";
  if (!is_sound(sample.beam_step_rad)) return "beam_step_rad is not finite";
  if (!is_sweep(sample.sweep_s)) return "sweep_s is more than ten seconds or not finite";
  if (!is_sound(sample.odom_from_base)) return "odom_from_base or its covariance is unsound";
  if (!is_sound(sample.map_from_odom)) return "map_from_odom is not finite";
  return "";
}

/// A scan that has its header and nothing else yet.
template <typename Scan, typename Sample>
Scan decode_scan_header(const Sample& sample) {
  Scan scan;
  scan.stamp_ns = sample.stamp_ns;
  scan.sequence = sample.sequence_number;
  scan.scanner_id = text(sample.scanner_id);
  scan.base_from_laser = decode(sample.base_from_laser);
  scan.max_range_m = sample.max_range_m;
  scan.beam_step_rad = sample.beam_step_rad;
  scan.sweep_s = sample.sweep_s;
  scan.odom_from_base = decode(sample.odom_from_base);
  scan.map_from_odom = decode(sample.map_from_odom);
  scan.map_id = {sample.map_id};
  scan.odom_id = {sample.odom_id};
  return scan;
}

}  // namespace slammot::wire
