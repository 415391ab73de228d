#include "services/slammot/stored_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "common/app/service_options.hpp"
#include "services/map_store/store.hpp"

namespace slammot {
namespace {

using files::Error;
using files::Result;
using map_store::Store;

constexpr const char* kFileName = "map.sqlite";

std::filesystem::path file_of(const std::filesystem::path& path) {
  return std::filesystem::is_directory(path) ? path / kFileName : path;
}

/// Loop closing cannot compare submaps with different cell sizes.
std::optional<Error> find_fault(const std::vector<flow::Submap>& submaps, double cell_size_m,
                                const std::string& name) {
  constexpr double kSame = 1e-6;
  const auto other = std::ranges::find_if(submaps, [&](const flow::Submap& submap) {
    return std::abs(submap.cell_size_m - cell_size_m) > kSame * cell_size_m;
  });
  if (other == submaps.end()) return std::nullopt;
  char text[128];
  std::snprintf(text, sizeof text,
                ": the map is of another profile, with cells of %g m instead of %g m",
                other->cell_size_m, cell_size_m);
  return Error{name + text};
}

Result<std::vector<flow::Submap>> read(Store& store, const std::string& name) {
  const std::vector<std::string> vehicles = store.vehicles();
  if (!store.last_fault().empty()) return Error{name + ": " + store.last_fault()};
  if (vehicles.empty()) return Error{name + ": contains no map"};
  if (vehicles.size() > 1)
    return Error{name + ": contains maps of " + std::to_string(vehicles.size()) +
                 " vehicles, one is expected"};
  std::vector<flow::Submap> submaps;
  for (const flow::SubmapId id : store.list(vehicles.front())) {
    auto submap = store.get(vehicles.front(), id);
    if (!submap) return Error{name + ": " + store.last_fault()};
    submap->map_id = {};  // One process has one map.
    submaps.push_back(std::move(*submap));
  }
  return submaps;
}

/// Of what the scans saw; the same after a merge.
std::size_t content_of(const flow::Submap& submap) {
  std::string bytes;
  const auto add = [&bytes](const void* data, std::size_t count) {
    bytes.append(static_cast<const char*>(data), count);
  };
  add(&submap.columns, sizeof submap.columns);
  add(&submap.rows, sizeof submap.rows);
  add(submap.so_log_odds.data(), submap.so_log_odds.size());
  add(submap.mo_evidence.data(), submap.mo_evidence.size());
  for (const flow::Surfel& surfel : submap.surfels) {
    for (const float value : {surfel.x_m, surfel.y_m, surfel.weight}) add(&value, sizeof value);
  }
  return std::hash<std::string>{}(bytes);
}

struct LatestMap {
  std::string vehicle_id;
  flow::MapId map_id;
};

/// None if it has no map.
std::optional<LatestMap> latest_map_of(Store& store) {
  const std::vector<std::string> vehicles = store.vehicles();
  if (vehicles.empty()) return std::nullopt;
  const std::vector<Store::StoredMap> maps = store.maps(vehicles.front());
  if (maps.empty()) return std::nullopt;
  return LatestMap{vehicles.front(), maps.back().map_id};
}

}  // namespace

std::size_t submaps_in_common(const std::vector<flow::Submap>& first,
                              const std::vector<flow::Submap>& second) {
  std::set<std::size_t> known;
  for (const flow::Submap& submap : first) known.insert(content_of(submap));
  return static_cast<std::size_t>(std::ranges::count_if(second, [&](const flow::Submap& submap) {
    return !submap.surfels.empty() && known.contains(content_of(submap));
  }));
}

std::filesystem::path database_of(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::path file = std::filesystem::weakly_canonical(file_of(path), ignored);
  return ignored ? path : file;
}

Result<std::vector<flow::Submap>> read_stored_map(const std::filesystem::path& path,
                                                  double cell_size_m) {
  const std::filesystem::path file = file_of(path);
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(file, unreadable))
    return Error{file.string() + ": no such file; slammot run --store-map writes it"};
  auto store = Store::open(file, {});
  if (const auto* fault = std::get_if<std::string>(&store)) return Error{*fault};
  auto submaps = read(std::get<Store>(store), file.string());
  if (!submaps) return submaps;
  if (const auto fault = find_fault(*submaps, cell_size_m, file.string())) return *fault;
  return submaps;
}

std::optional<Error> write_stored_map(const std::filesystem::path& folder,
                                      const std::map<flow::SubmapId, flow::Submap>& submaps) {
  std::vector<flow::Submap> ascending;
  for (const auto& [id, submap] : submaps) ascending.push_back(submap);
  return write_stored_map(folder, ascending, app::ServiceOptions().vehicle_id);
}

std::optional<Error> write_stored_map(const std::filesystem::path& folder,
                                      const std::vector<flow::Submap>& submaps,
                                      const std::string& vehicle_id) {
  const std::filesystem::path unfinished = folder / (std::string(kFileName) + ".part");
  std::error_code fault;
  std::filesystem::remove(unfinished, fault);
  {
    auto store = Store::open(unfinished, {});
    if (const auto* why = std::get_if<std::string>(&store)) return Error{*why};
    for (const flow::Submap& submap : submaps) {
      if (std::get<Store>(store).put(vehicle_id, submap) == map_store::PutResult::kFailed)
        return Error{unfinished.string() + ": " + std::get<Store>(store).last_fault()};
    }
  }
  // A closed database is a single file without a write-ahead log. Logs left by the previous file
  // would be applied to it.
  for (const char* ending : {"-wal", "-shm"})
    std::filesystem::remove(folder / (std::string(kFileName) + ending), fault);
  std::filesystem::rename(unfinished, folder / kFileName, fault);
  if (fault) return Error{(folder / kFileName).string() + ": " + fault.message()};
  return std::nullopt;
}

Result<traffic::SubmapTraffic> read_stored_traffic(const std::filesystem::path& path) {
  auto opened = Store::open(file_of(path), {});
  if (const auto* why = std::get_if<std::string>(&opened)) return Error{*why};
  Store& store = std::get<Store>(opened);
  traffic::SubmapTraffic traffic;
  const auto map = latest_map_of(store);
  if (!map) return traffic;
  for (Store::StoredTraffic& stored : store.traffic(map->vehicle_id, map->map_id)) {
    if (stored.streams) traffic.emplace(stored.submap_id, std::move(*stored.streams));
  }
  if (!store.last_fault().empty()) return Error{file_of(path).string() + ": " + store.last_fault()};
  return traffic;
}

std::optional<Error> write_stored_traffic(const std::filesystem::path& folder,
                                          const traffic::SubmapTraffic& traffic) {
  auto opened = Store::open(folder / kFileName, {});
  if (const auto* why = std::get_if<std::string>(&opened)) return Error{*why};
  Store& store = std::get<Store>(opened);
  const auto map = latest_map_of(store);
  if (!map) return std::nullopt;
  for (const auto& [submap_id, streams] : traffic) {
    if (!store.add_traffic(map->vehicle_id, map->map_id, submap_id, streams))
      return Error{(folder / kFileName).string() + ": " + store.last_fault()};
  }
  return std::nullopt;
}

std::optional<Error> copy_traffic(const std::filesystem::path& path,
                                  const std::filesystem::path& folder) {
  const auto traffic = read_stored_traffic(path);
  if (!traffic) return traffic.error();
  return write_stored_traffic(folder, *traffic);
}

}  // namespace slammot
