#include "common/files/record_traffic.hpp"

#include <map>
#include <utility>

#include "common/files/ways_file.hpp"
#include "common/traffic/mover_evidence.hpp"
#include "common/traffic/ways.hpp"

namespace slammot::files {
namespace {

/// States of one track, and the sums that decide its kind and width.
struct TrackHistory {
  std::vector<traffic::MoverState> states;
  traffic::MoverEvidence kind;
  double width_sum_m = 0.0;
};

traffic::MoverState state_of(const TrackRow& row, const geometry::Pose2& corrected_from_online) {
  const geometry::Matrix2 turn = geometry::rotation(corrected_from_online.heading_rad);
  Eigen::Matrix4d turn_of_state = Eigen::Matrix4d::Zero();
  turn_of_state.topLeftCorner<2, 2>() = turn_of_state.bottomRightCorner<2, 2>() = turn;
  return {row.stamp_ns, corrected_from_online * row.map_from_object.translation_m(),
          turn * row.velocity_in_map_mps,
          turn_of_state * row.covariance_in_map * turn_of_state.transpose()};
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
    history.kind.add(row->class_probability);
  }
  std::vector<traffic::Passage> passages;
  for (auto& [id, history] : histories) {
    const auto kind = history.kind.likeliest();
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
