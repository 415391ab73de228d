#include "services/map_store/map_store_service_traffic.hpp"

#include <algorithm>

#include "common/app/log.hpp"
#include "common/traffic/ways.hpp"
#include "common/wire/tracked_objects.hpp"

namespace slammot::map_store {
namespace {

using namespace std::chrono_literals;

constexpr auto kSilence = 1s;  // Only a clock tells that no data comes: ten scans of a slow
                               // scanner.
constexpr std::size_t kMostUnwritten = 64;

}  // namespace

TrafficOfSubmaps::TrafficOfSubmaps(app::ServiceContext& context, Store& store)
    : context_(context), store_(store), writer_(context.write(dds::topics::kTrafficWays)) {}

void TrafficOfSubmaps::begin_map(flow::MapId map_id) {
  if (map_id == map_id_) return;
  map_id_ = map_id;
  traffic_ = traffic::MapTraffic();
  for (Store::StoredTraffic& stored : store_.traffic(context_.vehicle_id(), map_id)) {
    if (stored.streams) traffic_.add(stored.submap_id, std::move(*stored.streams));
    else
      context_.warn(
          "unreadable_traffic",
          "what moved in submap " + std::to_string(stored.submap_id.value) + " is damaged");
  }
  if (!store_.last_fault().empty())
    context_.warn("unreadable_traffic", "cannot read what moved: " + store_.last_fault());
  if (traffic_.size() > 0)
    app::log_info("{} streams of what moved in {} submaps", traffic_.size(), traffic_.submaps());
  report();
}

void TrafficOfSubmaps::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!objects) return context_.warn("faulty_tracks", "dropped: " + std::string(objects.fault()));
  if (!drive_ || drive_->map_id != objects->map_id || drive_->odom_id != objects->odom_id)
    begin_drive(*objects);
  drive_->stamp_ns = objects->stamp_ns;
  drive_->map_from_odom = objects->map_from_odom;
  last_data_ = std::chrono::steady_clock::now();
  collector_.add(*objects);
}

/// In a new map it is located from the start.
void TrafficOfSubmaps::begin_drive(const flow::TrackedObjects& objects) {
  drive_ = Drive{objects.map_id, objects.odom_id, {}, 0, std::nullopt, false};
  const std::vector<Store::StoredMap> stored = store_.maps(context_.vehicle_id());
  drive_->is_located =
      std::ranges::find(stored, objects.map_id, &Store::StoredMap::map_id) == stored.end();
  begin_map(objects.map_id);
}

void TrafficOfSubmaps::take(const slammot_GraphCorrection& part) {
  const wire::GraphCorrectionAssembler::Added added = corrections_.add(part);
  if (!added.fault.empty())
    context_.warn("faulty_corrections", "dropped a correction: " + std::string(added.fault));
  if (!added.correction || added.correction->map_id != map_id_) return;
  traffic_.place(*added.correction);
  const auto& submaps = added.correction->submaps;
  if (drive_ && drive_->first_submap && !submaps.empty())
    drive_->is_located =
        !added.correction->is_untied && submaps.back().submap_id >= *drive_->first_submap;
}

void TrafficOfSubmaps::finish(const flow::Submap& submap) {
  if (drive_ && drive_->map_id == submap.map_id && !drive_->first_submap)
    drive_->first_submap = submap.submap_id;
  std::vector<traffic::FreeStream> streams = collector_.take(submap);
  if (streams.empty()) return;
  std::vector<traffic::FreeStream>& unwritten = unwritten_[{submap.map_id, submap.submap_id}];
  unwritten.insert(unwritten.end(), streams.begin(), streams.end());
  if (submap.map_id == map_id_) traffic_.add(submap.submap_id, std::move(streams));
  retry();
}

void TrafficOfSubmaps::retry() {
  while (!unwritten_.empty()) {
    const auto& [submap, streams] = *unwritten_.begin();
    const app::Stopwatch stopwatch(context_.status().latency("put_traffic"));
    if (!store_.add_traffic(context_.vehicle_id(), submap.first, submap.second, streams)) {
      context_.warn("failed_traffic_writes", "cannot store what moved: " + store_.last_fault());
      break;
    }
    unwritten_.erase(unwritten_.begin());
  }
  while (unwritten_.size() > kMostUnwritten) {
    context_.warn("lost_traffic", "lost what moved in a submap: it could not be written");
    unwritten_.erase(unwritten_.begin());
  }
  report();
}

void TrafficOfSubmaps::advance() {
  if (finding_.valid()) {
    if (finding_.wait_for(0s) == std::future_status::ready) publish(finding_.get());
    return;
  }
  if (may_find() && has_changed()) find();
}

bool TrafficOfSubmaps::may_find() const {
  const bool is_silent = std::chrono::steady_clock::now() - last_data_ > kSilence;
  return is_silent || !drive_ || pace_.is_due(drive_->stamp_ns, traffic_.size());
}

bool TrafficOfSubmaps::has_changed() {
  const bool has_more = collector_.parts() != told_parts_;
  told_parts_ = collector_.parts();
  return traffic_.take_change() || has_more;
}

/// With what waits for the end of the submap in use.
std::vector<traffic::PlacedTraffic> TrafficOfSubmaps::all_placed() const {
  std::vector<traffic::PlacedTraffic> placed = traffic_.placed();
  if (drive_ && drive_->is_located && drive_->map_id == map_id_)
    placed.push_back(
        {std::make_shared<const std::vector<traffic::FreeStream>>(collector_.waiting()),
         drive_->map_from_odom});
  return placed;
}

void TrafficOfSubmaps::find() {
  if (drive_) pace_.found(drive_->stamp_ns);
  finding_ = std::async(
      std::launch::async, [parts = all_placed(), map_id = map_id_.value_or(flow::MapId{})] {
        const auto start = std::chrono::steady_clock::now();
        Found found{traffic::find_ways(traffic::traffic_in_map(parts)), map_id, {}};
        found.took = std::chrono::steady_clock::now() - start;
        return found;
      });
}

void TrafficOfSubmaps::publish(Found found) {
  context_.status().latency("find_ways").add(found.took);
  if (found.map_id != map_id_) return;
  const std::size_t left_out = wire::TrafficWaysEncoder().encode(
      context_.vehicle_id(),
      {++sequence_, drive_ ? drive_->stamp_ns : 0, found.map_id, std::move(found.ways)},
      [this](const slammot_TrafficWays& part) { writer_.write(part); });
  if (left_out > 0)
    context_.warn("left_out_ways", std::to_string(left_out) + " ways do not fit on the bus");
  ++context_.status().counter("published_ways");
}

void TrafficOfSubmaps::report() {
  context_.status().counter("traffic_streams") = traffic_.size();
  context_.status().counter("traffic_submaps") = traffic_.submaps();
  context_.status().counter("left_out_traffic") = traffic_.left_out();
  context_.status().counter("unwritten_traffic") = unwritten_.size();
}

}  // namespace slammot::map_store
