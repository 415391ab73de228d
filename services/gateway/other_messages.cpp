#include "services/gateway/other_messages.hpp"

#include "services/gateway/message_parts.hpp"

namespace slammot::gateway {

foxglove::LocationFix fix_message(const sensing::GnssFix& fix) {
  foxglove::LocationFix message;
  set_time(fix.stamp_ns, *message.mutable_timestamp());
  message.set_frame_id(kBaseFrame);
  if (fix.quality == sensing::GnssQuality::no_fix) return message;
  message.set_latitude(fix.position.latitude_deg);
  message.set_longitude(fix.position.longitude_deg);
  message.set_altitude(fix.altitude_m);
  message.set_position_covariance_type(foxglove::LocationFix::KNOWN);
  for (const double entry : {fix.covariance_m2(0, 0), fix.covariance_m2(0, 1), 0.0,
                             fix.covariance_m2(1, 0), fix.covariance_m2(1, 1), 0.0, 0.0, 0.0, 0.0})
    message.add_position_covariance(entry);
  return message;
}

foxglove::Log log_message(std::int64_t stamp_ns, const std::string& warning) {
  foxglove::Log message;
  set_time(stamp_ns, *message.mutable_timestamp());
  message.set_level(foxglove::Log::WARNING);
  const std::size_t colon = warning.find(':');
  message.set_name(warning.substr(0, colon));
  message.set_message(warning);
  return message;
}

}  // namespace slammot::gateway
