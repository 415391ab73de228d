#include "services/gateway/map_publisher.hpp"

#include <utility>

#include "services/gateway/pose_messages.hpp"
#include "services/gateway/submap_view.hpp"
#include "services/gateway/way_messages.hpp"

namespace slammot::gateway {
namespace {

using namespace std::chrono_literals;

constexpr auto kWayPeriod = 2s;
constexpr auto kGridPeriod = 3s;

}  // namespace

MapView& MapPublisher::view_of(flow::MapId map_id) {
  return views_.try_emplace(map_id, map_id).first->second;
}

std::string_view MapPublisher::take(const slammot_SubmapTile& tile) {
  wire::SubmapAssembler::Added added = submaps_.add(tile);
  if (added.submap)
    arrived_.push_back({std::make_shared<const flow::Submap>(reduced(std::move(*added.submap))),
                        added.content_hash});
  return added.fault;
}

void MapPublisher::begin_submaps() {
  if (in_work_.valid() || arrived_.empty()) return;
  in_work_ = std::async(std::launch::async, [submaps = std::exchange(arrived_, {})]() mutable {
    for (ShownView& submap : submaps) submap.compressed_cells = compressed_cells(*submap.view);
    return std::move(submaps);
  });
}

void MapPublisher::finish() {
  if (in_work_.valid()) publish_submaps();
  begin_submaps();
  if (in_work_.valid()) in_work_.wait();
  if (grids_.valid()) grids_.wait();
}

void MapPublisher::publish_submaps() {
  for (ShownView& submap : in_work_.get()) add(std::move(submap));
}

void MapPublisher::add(ShownView submap) {
  const flow::MapId map_id = submap.view->map_id;
  const std::string path = view_of(map_id).add(std::move(submap.view), submap.version);
  std::string& served = served_[path.substr(0, path.rfind('/'))];
  if (!served.empty() && served != path) audience_.remove(served);
  served = path;
  Content content{"application/octet-stream", std::move(submap.compressed_cells), "gzip"};
  content.is_immutable = true;
  audience_.put(path, std::move(content));
  if (!in_use_) in_use_ = map_id;
  has_new_graph_ = has_new_map_ = true;
}

std::string_view MapPublisher::take(const slammot_GraphCorrection& part) {
  const wire::GraphCorrectionAssembler::Added added = corrections_.add(part);
  if (added.correction) {
    view_of(added.correction->map_id).correct(*added.correction);
    has_new_graph_ = has_new_map_ = true;
  }
  return added.fault;
}

std::string_view MapPublisher::take(const slammot_TrafficWays& part) {
  wire::TrafficWaysAssembler::Added added = traffic_.add(part);
  if (added.ways) ways_ = std::move(added.ways);
  return added.fault;
}

void MapPublisher::take(const flow::Constraint& constraint) {
  view_of(constraint.map_id).add(constraint);
  has_new_graph_ = true;
}

/// A new map replaces the one before, which nobody asks for any more.
void MapPublisher::follow(const flow::LocalizedScan& scan) {
  stamp_ns_ = scan.stamp_ns;
  if (in_use_ != scan.map_id) {
    in_use_ = scan.map_id;
    std::erase_if(views_, [&](const auto& item) { return item.first != scan.map_id; });
    const std::string kept = "/submaps/" + std::to_string(scan.map_id.value) + "/";
    std::erase_if(served_, [&](const auto& item) {
      if (item.second.starts_with(kept)) return false;
      audience_.remove(item.second);
      return true;
    });
    has_new_graph_ = has_new_map_ = true;
    if (!ways_ || ways_->map_id != scan.map_id)
      ways_ = traffic::TrafficWays{0, scan.stamp_ns, scan.map_id, {}};
  }
  view_of(scan.map_id).follow(scan);
}

void MapPublisher::publish(Time now) {
  if (in_work_.valid() && in_work_.wait_for(0s) == std::future_status::ready) publish_submaps();
  begin_submaps();
  if (!in_use_) return;
  if (std::exchange(has_new_graph_, false)) publish_graph();
  publish_ways();
  publish_way(now);
  publish_grids(now);
}

void MapPublisher::publish_graph() {
  audience_.publish(ChannelId::kGraph, stamp_ns_, view_of(*in_use_).graph_json());
}

void MapPublisher::publish_way(Time now) {
  if (now < way_due_) return;
  way_due_ = now + kWayPeriod;
  audience_.publish(ChannelId::kTrajectory, stamp_ns_,
                    poses_message(stamp_ns_, view_of(*in_use_).way()).SerializeAsString());
}

/// Those of another map wait: it may come into use.
void MapPublisher::publish_ways() {
  if (!ways_ || ways_->map_id != in_use_) return;
  audience_.publish(ChannelId::kWays, stamp_ns_, ways_scene(*ways_).SerializeAsString());
  audience_.publish(ChannelId::kWayDetails, stamp_ns_, ways_json(*ways_));
  ways_.reset();
}

void MapPublisher::publish_grids(Time now) {
  if (grids_.valid()) {
    if (grids_.wait_for(0s) != std::future_status::ready) return;
    MapGrids grids = grids_.get();
    audience_.publish(ChannelId::kStationaryMap, stamp_ns_, std::move(grids.stationary));
    audience_.publish(ChannelId::kMovingMap, stamp_ns_, std::move(grids.moving));
  }
  const bool is_wanted =
      audience_.is_wanted(ChannelId::kStationaryMap) || audience_.is_wanted(ChannelId::kMovingMap);
  if (!is_wanted || now < grids_due_ || !std::exchange(has_new_map_, false)) return;
  grids_due_ = now + kGridPeriod;
  grids_ =
      std::async(std::launch::async, [submaps = view_of(*in_use_).submaps(), stamp_ns = stamp_ns_] {
        return map_grids(stamp_ns, submaps);
      });
}

}  // namespace slammot::gateway
