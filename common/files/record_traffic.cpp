#include "common/files/record_traffic.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "common/files/ways_file.hpp"
#include "common/traffic/ways.hpp"

namespace slammot::files {
namespace {

using traffic::Mover;

/// States of one track, and the sums that decide its kind and width.
struct TrackHistory {
  std::vector<traffic::MoverState> states;
  std::array<double, traffic::kMovers> kind_sum = {};
  double width_sum_m = 0.0;
};

void count_class(const TrackRow& row, TrackHistory& history) {
  const auto add = [&](Mover mover, double probability) {
    history.kind_sum[static_cast<std::size_t>(mover)] += probability;
  };
  const auto& [pedestrian, bicycle, car, truck_or_bus] = row.class_probability;
  add(Mover::kPedestrian, pedestrian);
  add(Mover::kBicycle, bicycle);
  add(Mover::kVehicle, car + truck_or_bus);
}

traffic::MoverState state_of(const TrackRow& row, const geometry::Pose2& corrected_from_online) {
  const geometry::Matrix2 turn = geometry::rotation(corrected_from_online.heading_rad);
  Eigen::Matrix4d turn_of_state = Eigen::Matrix4d::Zero();
  turn_of_state.topLeftCorner<2, 2>() = turn_of_state.bottomRightCorner<2, 2>() = turn;
  return {row.stamp_ns, corrected_from_online * row.map_from_object.translation_m(),
          turn * row.velocity_in_map_mps,
          turn_of_state * row.covariance_in_map * turn_of_state.transpose()};
}

/// The likeliest kind; none if no class was computed.
std::optional<Mover> kind_of(const TrackHistory& history) {
  const auto likeliest = std::ranges::max_element(history.kind_sum);
  if (*likeliest <= 0.0) return std::nullopt;
  return static_cast<Mover>(likeliest - history.kind_sum.begin());
}

}  // namespace

std::vector<traffic::Passage> passages_of(const RunRecord& record) {
  std::map<flow::TrackId, TrackHistory> histories;
  std::int64_t stamp_ns = -1;
  geometry::Pose2 corrected_from_online;
  for (const TrackRow* row : record.track_rows()) {
    if (row->motion != flow::Motion::kMoving || row->occluded) continue;
    if (row->stamp_ns != stamp_ns) {
      stamp_ns = row->stamp_ns;
      corrected_from_online = record.corrected_from_online(stamp_ns);
    }
    TrackHistory& history = histories[row->track_id];
    history.states.push_back(state_of(*row, corrected_from_online));
    history.width_sum_m += row->width_m;
    count_class(*row, history);
  }
  std::vector<traffic::Passage> passages;
  for (auto& [id, history] : histories) {
    const auto kind = kind_of(history);
    if (!kind) continue;
    const double width_m = history.width_sum_m / static_cast<double>(history.states.size());
    passages.push_back({*kind, width_m, std::move(history.states)});
  }
  return passages;
}

traffic::TrafficMap traffic_of(const RunRecord& record) {
  traffic::TrafficMap map;
  for (const traffic::Passage& passage : passages_of(record)) map.add(passage);
  return map;
}

std::string lanes_geojson(const RunRecord& record) {
  return to_geojson(traffic::find_ways(traffic_of(record)));
}

}  // namespace slammot::files
