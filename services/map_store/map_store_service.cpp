#include "services/map_store/map_store_service.hpp"

#include <algorithm>
#include <cstdlib>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/map_store/map_store_fields.hpp"

namespace slammot::map_store {
namespace {

constexpr std::chrono::milliseconds kAdvancePeriod{50};

std::string names_of(const std::vector<Store::StoredMap>& maps) {
  std::string names;
  for (const Store::StoredMap& map : maps)
    names += (names.empty() ? "; available: " : ", ") + std::to_string(map.map_id.value) + " (" +
             std::to_string(map.submaps) + " submaps)";
  return names;
}

Store open_store(const app::ServiceContext& context, const MapStoreService::Settings& settings) {
  const auto file =
      settings.database.empty() ? context.options().state_dir / "map.sqlite" : settings.database;
  auto opened = Store::open(file, settings.config);
  if (const auto* fault = std::get_if<std::string>(&opened)) throw app::Unavailable(*fault);
  Store store = std::move(std::get<Store>(opened));
  if (settings.map_id && !store.make_latest(context.vehicle_id(), {*settings.map_id})) {
    const std::string why = store.last_fault().empty()
                                ? "no such map of vehicle " + context.vehicle_id()
                                : store.last_fault();
    throw app::StartupFailure("--map " + std::to_string(*settings.map_id) + ": " + why +
                              names_of(store.maps(context.vehicle_id())));
  }
  return store;
}

}  // namespace

std::vector<config::BoundStage> MapStoreService::stages(Settings& settings) {
  return {config::bind_stage("map_store", map_store_fields(), settings.config)};
}

void MapStoreService::add_options(CLI::App& command_line, Settings& settings) {
  command_line.add_option("--database", settings.database,
                          "SQLite file; default: map.sqlite in the state folder");
  command_line
      .add_option("--map", settings.map_id, "Use this map of the vehicle instead of its latest")
      ->type_name("ID");
}

MapStoreService::MapStoreService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      store_(open_store(context, settings)),
      stored_submaps_(context, store_),
      traffic_(context, store_),
      relay_(context),
      stored_map_(context.write(dds::topics::kStoredMap)) {
  read_stored();
  read_inputs();
  context.every(std::chrono::nanoseconds(static_cast<std::int64_t>(config_.retry_after_s * 1e9)),
                [this] { retry(); });
  context.every(kAdvancePeriod, [this] {
    stored_submaps_.advance();
    traffic_.advance();
  });
}

void MapStoreService::read_inputs() {
  context_.read(dds::topics::kSubmapTile, app::Input::kOccasional,
                [this](const auto& tile) { take(tile); });
  context_.read(dds::topics::kTrackedObjects, app::Input::kOccasional,
                [this](const slammot_TrackedObjects& objects) {
                  relay_.take(objects);
                  traffic_.take(objects);
                });
  context_.read(dds::topics::kGraphCorrection, app::Input::kOccasional,
                [this](const slammot_GraphCorrection& part) { traffic_.take(part); });
}

TrackRelay::TrackRelay(app::ServiceContext& context)
    : writer_(context.write(dds::topics::kStoredTrackedObjects)) {
  writer_.write(wire::TrackedObjectsEncoder().encode(context.vehicle_id(), {}));
}

void TrackRelay::take(const slammot_TrackedObjects& objects) {
  constexpr std::int64_t kPeriodNs = 100'000'000;
  if (relayed_ns_ && std::abs(objects.stamp_ns - *relayed_ns_) < kPeriodNs) return;
  relayed_ns_ = objects.stamp_ns;
  writer_.write(objects);
}

void MapStoreService::take(const slammot_SubmapTile& tile) {
  wire::SubmapAssembler::Added added = assembler_.add(tile);
  if (!added.fault.empty())
    context_.warn("faulty_tiles", "dropped a submap tile: " + std::string(added.fault));
  context_.status().counter("tiles") = assembler_.counters().tiles;
  context_.status().counter("incomplete_submaps") = assembler_.incomplete();
  if (added.submap && !store(*added.submap)) defer(std::move(*added.submap));
}

/// Stores and publishes a submap. Returns false if the write failed.
bool MapStoreService::store(const flow::Submap& submap) {
  const app::Stopwatch stopwatch(context_.status().latency("put"));
  const PutResult result = store_.put(context_.vehicle_id(), submap);
  if (result == PutResult::kFailed) {
    context_.warn("failed_writes", "cannot store submap " + std::to_string(submap.submap_id.value) +
                                       ": " + store_.last_fault());
    context_.status().set_trouble("database", "cannot store submaps: " + store_.last_fault());
    return false;
  }
  context_.status().clear_trouble("database");
  if (result == PutResult::kStored) {
    ++context_.status().counter("stored_submaps");
    if (map_id_ != submap.map_id) begin_map();
    note(submap);
    stored_submaps_.publish(submap);
    publish_stored_map();
    traffic_.finish(submap);
  }
  return true;
}

void MapStoreService::defer(flow::Submap submap) {
  unwritten_.push_back(std::move(submap));
  if (unwritten_.size() > static_cast<std::size_t>(config_.max_unwritten_submaps)) {
    context_.warn("lost_submaps", "lost submap " +
                                      std::to_string(unwritten_.front().submap_id.value) +
                                      ": it could not be written");
    unwritten_.pop_front();
  }
  context_.status().counter("unwritten_submaps") = unwritten_.size();
}

void MapStoreService::keep_file() {
  switch (store_.keep_file()) {
    case Store::FileState::kThere: break;
    case Store::FileState::kWrittenAnew:
      context_.warn("deleted_databases", "the database was deleted: written anew");
      break;
    case Store::FileState::kGone:
      context_.status().set_trouble("database file", store_.last_fault());
      return;
  }
  context_.status().clear_trouble("database file");
}

void MapStoreService::retry() {
  keep_file();
  while (!unwritten_.empty() && store(unwritten_.front())) unwritten_.pop_front();
  traffic_.retry();
  context_.status().counter("unwritten_submaps") = unwritten_.size();
}

void MapStoreService::read_stored() {
  const auto count_unreadable = [this](flow::SubmapId id) {
    unreadable_.insert(id);
    context_.warn("unreadable_submaps", store_.last_fault());
  };
  const std::vector<flow::SubmapId> ids = store_.list(context_.vehicle_id());
  if (!store_.last_fault().empty()) count_unreadable({});
  for (const flow::SubmapId id : ids) {
    if (const auto submap = store_.get(context_.vehicle_id(), id)) note(*submap);
    else count_unreadable(id);
  }
  const std::vector<Store::StoredMap> maps = store_.maps(context_.vehicle_id());
  if (!readable_.empty())
    app::log_info("{} submaps in the database, of map {}{}", readable_.size(), map_id_.value,
                  maps.size() > 1 ? names_of(maps) : "");
  else report_other_vehicles();
  publish_stored_map();
  if (!readable_.empty()) traffic_.begin_map(map_id_);
}

/// Logs the vehicles that have maps: a stored map belongs to the id of one vehicle.
void MapStoreService::report_other_vehicles() {
  std::string names;
  const std::vector<std::string> vehicles = store_.vehicles();
  for (const std::string& vehicle : vehicles) names += (names.empty() ? "" : ", ") + vehicle;
  context_.status().counter("other_vehicles") = vehicles.size();
  if (!vehicles.empty())
    app::log_warn("the database has no map of vehicle {}, but of: {}", context_.vehicle_id(),
                  names);
}

/// Publishes the description of the stored map after each change.
void MapStoreService::publish_stored_map() {
  const std::vector<flow::SubmapId> stored = store_.list(context_.vehicle_id());
  const flow::SubmapId last = stored.empty() ? flow::SubmapId{} : stored.back();
  stored_map_.write(wire::encode(
      context_.vehicle_id(),
      flow::StoredMap{map_id_, static_cast<std::uint32_t>(readable_.size()),
                      static_cast<std::uint32_t>(unreadable_.size()), last, cell_size_m_}));
}

void MapStoreService::note(const flow::Submap& submap) {
  readable_.insert(submap.submap_id);
  unreadable_.erase(submap.submap_id);
  map_id_ = submap.map_id;
  cell_size_m_ = submap.cell_size_m;
}

/// Another map is the latest from now on.
void MapStoreService::begin_map() {
  stored_submaps_.withdraw();
  unreadable_.clear();
  const std::vector<flow::SubmapId> stored = store_.list(context_.vehicle_id());
  readable_ = {stored.begin(), stored.end()};
}

}  // namespace slammot::map_store
