#include "common/traffic/map_traffic.hpp"

#include <cmath>
#include <utility>

namespace slammot::traffic {
namespace {

// Below these a move is not worth finding all ways again.
constexpr double kMovedM = 0.05;
constexpr double kTurnedRad = 0.002;

bool is_moved(const geometry::Pose2& before, const geometry::Pose2& now) {
  const Eigen::Vector3d moved = geometry::difference(now, before);
  return moved.head<2>().norm() > kMovedM || std::abs(moved.z()) > kTurnedRad;
}

}  // namespace

TrafficMap traffic_in_map(const std::vector<PlacedTraffic>& parts) {
  TrafficMap map;
  for (const PlacedTraffic& part : parts) map.add(*part.streams, part.map_from_submap);
  return map;
}

void MapTraffic::add(flow::SubmapId submap_id, std::vector<FreeStream> streams) {
  if (streams.empty()) return;
  Part& part = parts_[submap_id];
  streams_ += streams.size();
  if (part.streams) streams.insert(streams.end(), part.streams->begin(), part.streams->end());
  part.streams = std::make_shared<const std::vector<FreeStream>>(std::move(streams));
  part.told_pose.reset();
  forget_earliest();
}

void MapTraffic::forget_earliest() {
  while (streams_ > most_streams_ && parts_.size() > 1) {
    streams_ -= parts_.begin()->second.streams->size();
    parts_.erase(parts_.begin());
    ++left_out_;
    has_changed_ = true;
  }
}

void MapTraffic::place(const flow::GraphCorrection& correction) {
  for (const flow::CorrectedSubmap& corrected : correction.submaps) {
    const auto known = map_from_submap_.find(corrected.submap_id);
    if (known != map_from_submap_.end()) known->second = corrected.map_from_submap;
    else if (!correction.is_untied)
      map_from_submap_.emplace(corrected.submap_id, corrected.map_from_submap);
  }
}

std::vector<PlacedTraffic> MapTraffic::placed() const {
  std::vector<PlacedTraffic> placed;
  for (const auto& [submap_id, part] : parts_) {
    const auto pose = map_from_submap_.find(submap_id);
    if (pose != map_from_submap_.end()) placed.push_back({part.streams, pose->second});
  }
  return placed;
}

bool MapTraffic::take_change() {
  bool has_moved = false;
  for (const auto& [submap_id, part] : parts_) {
    const auto pose = map_from_submap_.find(submap_id);
    if (pose == map_from_submap_.end()) continue;
    has_moved = has_moved || !part.told_pose || is_moved(*part.told_pose, pose->second);
  }
  if (!std::exchange(has_changed_, false) && !has_moved) return false;
  for (auto& [submap_id, part] : parts_) {
    const auto pose = map_from_submap_.find(submap_id);
    if (pose != map_from_submap_.end()) part.told_pose = pose->second;
  }
  return true;
}

}  // namespace slammot::traffic
