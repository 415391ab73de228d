#include "common/wire/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {

const slammot_LaserScan& LaserScanEncoder::encode(std::string_view vehicle_id,
                                                  const sensing::LaserScan& scan) {
  if (scan.range_m.size() > kMostBeams) {
    throw std::length_error("a scan of " + std::to_string(scan.range_m.size()) +
                            " beams: at most " + std::to_string(kMostBeams) + " fit on the bus");
  }
  ranges_m_ = scan.range_m;
  set_text(sample_.vehicle_id, vehicle_id);
  set_text(sample_.scanner_id, scan.scanner.scanner_id);
  sample_.stamp_ns = scan.stamp_ns;
  sample_.sequence_number = scan.sequence;
  sample_.base_from_laser = wire::encode(scan.scanner.base_from_laser);
  sample_.first_beam_rad = scan.scanner.first_beam_rad;
  sample_.beam_step_rad = scan.scanner.beam_step_rad;
  sample_.max_range_m = scan.scanner.max_range_m;
  sample_.sweep_s = scan.scanner.sweep_s;
  show(sample_.ranges_m, ranges_m_);
  return sample_;
}

Decoded<sensing::LaserScan> decode(const slammot_LaserScan& sample) {
  if (!is_sound(sample.base_from_laser)) return Fault{"base_from_laser is not finite"};
  if (!is_sound(sample.first_beam_rad) || !is_sound(sample.beam_step_rad))
    return Fault{"beam angles are not finite"};
  if (!is_amount(sample.max_range_m) || sample.max_range_m == 0.0)
    return Fault{"max_range_m is not above zero"};
  if (!is_amount(sample.sweep_s) || !is_sweep(sample.sweep_s))
    return Fault{"sweep_s is negative, more than ten seconds or not finite"};
  const auto ranges_m = elements(sample.ranges_m);
  if (ranges_m.empty()) return Fault{"no beams"};
  return sensing::LaserScan{.stamp_ns = sample.stamp_ns,
                            .sequence = sample.sequence_number,
                            .scanner = {.scanner_id = std::string(text(sample.scanner_id)),
                                        .base_from_laser = decode(sample.base_from_laser),
                                        .first_beam_rad = sample.first_beam_rad,
                                        .beam_step_rad = sample.beam_step_rad,
                                        .max_range_m = sample.max_range_m,
                                        .sweep_s = sample.sweep_s},
                            .range_m = {ranges_m.begin(), ranges_m.end()}};
}

slammot_Odometry encode(std::string_view vehicle_id, const sensing::Odometry& odometry) {
  slammot_Odometry sample{};
  set_text(sample.vehicle_id, vehicle_id);
  sample.stamp_ns = odometry.stamp_ns;
  sample.wheel_from_base = encode(odometry.wheel_from_base);
  return sample;
}

Decoded<sensing::Odometry> decode(const slammot_Odometry& sample) {
  if (!is_sound(sample.wheel_from_base)) return Fault{"wheel_from_base is not finite"};
  return sensing::Odometry{sample.stamp_ns, decode(sample.wheel_from_base)};
}

slammot_GnssFix encode(std::string_view vehicle_id, const sensing::GnssFix& fix) {
  slammot_GnssFix sample{};
  set_text(sample.vehicle_id, vehicle_id);
  set_text(sample.receiver_id, fix.receiver_id);
  sample.stamp_ns = fix.stamp_ns;
  sample.quality = static_cast<slammot_GnssQuality>(fix.quality);
  sample.latitude_deg = fix.position.latitude_deg;
  sample.longitude_deg = fix.position.longitude_deg;
  sample.altitude_m = fix.altitude_m;
  encode_matrix<2>(fix.covariance_m2, sample.covariance_m2);
  sample.hdop = fix.hdop;
  sample.satellite_count = static_cast<std::uint16_t>(std::clamp(fix.satellites, 0, 0xffff));
  return sample;
}

Decoded<sensing::GnssFix> decode(const slammot_GnssFix& sample) {
  if (!is_enumerator(sample.quality, slammot_GNSS_QUALITY_RTK))
    return Fault{"quality is none of the enumerators"};
  sensing::GnssFix fix;
  fix.stamp_ns = sample.stamp_ns;
  fix.receiver_id = text(sample.receiver_id);
  fix.quality = static_cast<sensing::GnssQuality>(sample.quality);
  fix.satellites = sample.satellite_count;
  if (fix.quality == sensing::GnssQuality::no_fix) return fix;
  if (!(std::abs(sample.latitude_deg) <= 90.0) || !(std::abs(sample.longitude_deg) <= 360.0))
    return Fault{"the position is not on the earth"};
  if (!is_sound(sample.altitude_m) || !is_amount(sample.hdop))
    return Fault{"altitude_m or hdop is unsound"};
  if (!is_covariance<2>(sample.covariance_m2)) return Fault{"covariance_m2 is unsound"};
  fix.position = {sample.latitude_deg, sample.longitude_deg};
  fix.altitude_m = sample.altitude_m;
  fix.covariance_m2 = decode_matrix<2>(sample.covariance_m2);
  fix.hdop = sample.hdop;
  return fix;
}

slammot_CompassReading encode(std::string_view vehicle_id, const sensing::CompassReading& reading) {
  slammot_CompassReading sample{};
  set_text(sample.vehicle_id, vehicle_id);
  set_text(sample.compass_id, reading.compass_id);
  sample.stamp_ns = reading.stamp_ns;
  sample.heading_from_east_rad = reading.heading_from_east_rad;
  sample.sigma_rad = reading.sigma_rad;
  return sample;
}

Decoded<sensing::CompassReading> decode(const slammot_CompassReading& sample) {
  if (!is_sound(sample.heading_from_east_rad)) return Fault{"heading_from_east_rad is not finite"};
  if (!is_amount(sample.sigma_rad)) return Fault{"sigma_rad is negative or not finite"};
  return sensing::CompassReading{sample.stamp_ns, std::string(text(sample.compass_id)),
                                 sample.heading_from_east_rad, sample.sigma_rad};
}

}  // namespace slammot::wire
