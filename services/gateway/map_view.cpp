#include "services/gateway/map_view.hpp"

#include <cstdint>

#include "services/gateway/json_parts.hpp"

namespace slammot::gateway {
namespace {

Json constraint_json(const flow::Constraint& constraint) {
  return {{"from", constraint.from.value},
          {"to", constraint.to.value},
          {"loop", constraint.kind == flow::ConstraintKind::kLoop},
          {"pose", json_of(constraint.from_to.pose)},
          {"state", flow::to_text(constraint.verdict.state)},
          {"squared_error", constraint.verdict.squared_error},
          {"agreed_share", constraint.verdict.agreed_share},
          {"reason", constraint.verdict.reason}};
}

Json submap_json(flow::SubmapId submap_id, const ShownSubmap& shown, const geometry::Pose2& pose) {
  const flow::Submap& submap = *shown.submap;
  return {{"id", submap_id.value},
          {"pose", json_of(pose)},
          {"path", shown.path},
          {"columns", submap.columns},
          {"rows", submap.rows},
          {"cell_size_m", submap.cell_size_m},
          {"min", {submap.min_x_m, submap.min_y_m}},
          {"travelled_m", submap.travelled_m},
          {"last_stamp_ns", std::to_string(submap.last_stamp_ns)}};
}

}  // namespace

std::string MapView::add(std::shared_ptr<const flow::Submap> submap, std::uint64_t version) {
  const flow::SubmapId submap_id = submap->submap_id;
  const std::string path = "/submaps/" + std::to_string(map_id_.value) + "/" +
                           std::to_string(submap_id.value) + "/" + std::to_string(version);
  map_from_submap_.try_emplace(submap_id, submap->odom_from_submap);
  submaps_[submap_id] = {std::move(submap), path, {}};
  return path;
}

void MapView::add(const flow::Constraint& constraint) {
  constraints_[{constraint.from, constraint.to, constraint.kind}] = constraint;
}

void MapView::correct(const flow::GraphCorrection& correction) {
  for (const flow::CorrectedSubmap& corrected : correction.submaps)
    map_from_submap_[corrected.submap_id] = corrected.map_from_submap;
}

void MapView::follow(const flow::LocalizedScan& scan) {
  map_from_submap_[scan.submap_id] =
      scan.map_from_odom * scan.odom_from_base.pose * inverse(scan.submap_from_base);
  if (!way_.empty() && way_.back().submap_id == scan.submap_id &&
      (way_.back().submap_from_base.translation_m() - scan.submap_from_base.translation_m())
              .norm() < spacing_m_)
    return;
  way_.push_back({scan.submap_id, scan.submap_from_base});
  if (way_.size() > kMostPoses) thin_out();
}

void MapView::thin_out() {
  std::vector<WayPoint> thinned;
  for (std::size_t i = 0; i < way_.size(); i += 2) thinned.push_back(way_[i]);
  way_ = std::move(thinned);
  spacing_m_ *= 2.0;
}

geometry::Pose2 MapView::pose_of(flow::SubmapId submap_id) const {
  const auto found = map_from_submap_.find(submap_id);
  return found == map_from_submap_.end() ? geometry::Pose2{} : found->second;
}

std::vector<geometry::Pose2> MapView::way() const {
  std::vector<geometry::Pose2> poses;
  for (const WayPoint& point : way_)
    poses.push_back(pose_of(point.submap_id) * point.submap_from_base);
  return poses;
}

std::vector<ShownSubmap> MapView::submaps() const {
  std::vector<ShownSubmap> shown;
  for (const auto& [submap_id, submap] : submaps_)
    shown.push_back({submap.submap, submap.path, pose_of(submap_id)});
  return shown;
}

std::string MapView::graph_json() const {
  Json json = {{"map", std::to_string(map_id_.value)},
               {"submaps", Json::array()},
               {"constraints", Json::array()}};
  for (const auto& [submap_id, shown] : submaps_)
    json["submaps"].push_back(submap_json(submap_id, shown, pose_of(submap_id)));
  for (const auto& [key, constraint] : constraints_)
    json["constraints"].push_back(constraint_json(constraint));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace slammot::gateway
