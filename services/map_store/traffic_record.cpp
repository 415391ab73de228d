#include "services/map_store/traffic_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/map_store/blob.hpp"
#include "traffic_record.pb.h"

namespace slammot::map_store {
namespace {

constexpr float kLargestSum = 1e12F;

TrafficRecord record_of(const std::vector<traffic::FreeStream>& streams) {
  TrafficRecord record;
  for (const traffic::FreeStream& stream : streams) {
    record.add_mover(static_cast<std::uint32_t>(stream.mover));
    record.add_passages(stream.passages);
    record.add_x_m(stream.position_m.x());
    record.add_y_m(stream.position_m.y());
    record.add_length_m(stream.length_m);
    record.add_weight(stream.weight);
    record.add_direction_x(stream.direction_sum.x());
    record.add_direction_y(stream.direction_sum.y());
    record.add_speed_mps(stream.speed_sum_mps);
    record.add_squared_speed(stream.squared_speed_sum);
    record.add_width_m(stream.width_sum_m);
  }
  return record;
}

bool has_equal_lengths(const TrafficRecord& record) {
  const std::array sizes = {record.passages_size(),      record.x_m_size(),
                            record.y_m_size(),           record.length_m_size(),
                            record.weight_size(),        record.direction_x_size(),
                            record.direction_y_size(),   record.speed_mps_size(),
                            record.squared_speed_size(), record.width_m_size()};
  return std::ranges::all_of(sizes, [&](int size) { return size == record.mover_size(); });
}

traffic::FreeStream stream_of(const TrafficRecord& record, int i) {
  return {static_cast<traffic::Mover>(record.mover(i)),
          record.passages(i),
          {record.x_m(i), record.y_m(i)},
          record.length_m(i),
          record.weight(i),
          {record.direction_x(i), record.direction_y(i)},
          record.speed_mps(i),
          record.squared_speed(i),
          record.width_m(i)};
}

bool is_sound_stream(const traffic::FreeStream& stream) {
  const auto is_sum = [](float sum) { return sum >= 0.0F && sum <= kLargestSum; };
  return stream.position_m.cwiseAbs().maxCoeff() < static_cast<float>(traffic::kFarthestM) &&
         stream.position_m.allFinite() && stream.direction_sum.allFinite() &&
         stream.direction_sum.norm() > 0.0F && stream.direction_sum.norm() <= kLargestSum &&
         stream.weight > 0.0F && is_sum(stream.weight) && is_sum(stream.length_m) &&
         is_sum(stream.speed_sum_mps) && is_sum(stream.squared_speed_sum) &&
         is_sum(stream.width_sum_m);
}

}  // namespace

std::string to_traffic_blob(const std::vector<traffic::FreeStream>& streams) {
  return deflated(record_of(streams).SerializeAsString());
}

std::optional<std::vector<traffic::FreeStream>> from_traffic_blob(std::string_view blob) {
  const std::optional<std::string> bytes = inflated(blob);
  TrafficRecord record;
  if (!bytes || !record.ParseFromString(*bytes) || !has_equal_lengths(record)) return std::nullopt;
  std::vector<traffic::FreeStream> streams;
  streams.reserve(static_cast<std::size_t>(record.mover_size()));
  for (int i = 0; i < record.mover_size(); ++i) {
    if (record.mover(i) >= static_cast<std::uint32_t>(traffic::kMovers)) return std::nullopt;
    streams.push_back(stream_of(record, i));
    if (!is_sound_stream(streams.back())) return std::nullopt;
  }
  return streams;
}

}  // namespace slammot::map_store
