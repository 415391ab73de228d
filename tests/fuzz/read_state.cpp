#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include <zlib.h>

#include "common/traffic/ways.hpp"
#include "services/gateway/protocol.hpp"
#include "services/localization/byte_stream.hpp"
#include "services/localization/localizer.hpp"
#include "services/map_store/store.hpp"
#include "services/map_store/submap_record.hpp"
#include "services/map_store/traffic_record.hpp"
#include "tests/fuzz/edits.hpp"
#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tests/support/example_streams.hpp"
#include "tests/support/example_submap.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::fuzz {
namespace {

void require_usable(const flow::Submap& submap) {
  const auto cells =
      static_cast<std::size_t>(submap.columns) * static_cast<std::size_t>(submap.rows);
  require(submap.so_log_odds.size() == cells && submap.mo_evidence.size() == cells,
          "grids have the size that they state");
  require(map_store::from_blob(map_store::to_blob(submap)).has_value(),
          "a submap can be stored again");
}

void require_usable(const std::vector<traffic::FreeStream>& streams) {
  traffic::TrafficMap map(2000);
  map.add(streams, {1.0, 2.0, 0.5});
  for (const traffic::Way& way : traffic::find_ways(map)) {
    require(way.points_in_map_m.size() >= 2, "a way has two points");
    require(std::isfinite(way.confidence), "a way has a confidence");
  }
  require(map_store::from_traffic_blob(map_store::to_traffic_blob(streams)).has_value(),
          "traffic can be stored again");
}

/// The bytes as the database holds them: so that damage reaches the record behind the compression.
std::string packed(std::string_view bytes) {
  uLongf size = compressBound(bytes.size());
  const auto length = static_cast<std::uint32_t>(bytes.size());
  std::string blob(size + sizeof length, '\0');
  std::memcpy(blob.data(), &length, sizeof length);
  compress2(reinterpret_cast<Bytef*>(blob.data()) + sizeof length, &size,
            reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), 1);
  blob.resize(size + sizeof length);
  return blob;
}

/// A record of the database before compression.
std::string unpacked(const std::string& blob) {
  std::uint32_t length = 0;
  std::memcpy(&length, blob.data(), sizeof length);
  std::string record(length, '\0');
  uLongf size = length;
  uncompress(reinterpret_cast<Bytef*>(record.data()), &size,
             reinterpret_cast<const Bytef*>(blob.data()) + sizeof length,
             blob.size() - sizeof length);
  return record;
}

/// With the checksum that fits, as that of a checkpoint that a fault wrote rather than damaged.
std::vector<std::byte> sealed(std::string_view bytes) {
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  std::vector<std::byte> state(begin, begin + bytes.size());
  localization::put(state, localization::checksum(state));
  return state;
}

localization::LocalizerConfig small_map() {
  localization::LocalizerConfig config;
  config.map.side_m = 24.0;
  return config;
}

testing::SimulatedDrive room_drive() {
  return testing::SimulatedDrive(
      {.world = testing::room(), .world_from_base_at = testing::arc({0.0, -3.0, 0.0}, 0.5, 0.2)});
}

/// Of a drive of ten scans, without its checksum.
std::string example_checkpoint() {
  testing::SimulatedDrive drive = room_drive();
  localization::Localizer localizer(small_map());
  testing::drive_through(localizer, drive, 0, 10);
  const std::vector<std::byte> state = localizer.checkpoint();
  return {reinterpret_cast<const char*>(state.data()), state.size() - sizeof(std::uint64_t)};
}

std::string file_content(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

/// A database of two submaps.
std::string example_database() {
  const testing::TemporaryFolder folder;
  const auto file = folder / "map.sqlite";
  {
    auto opened = map_store::Store::open(file, {});
    auto& store = std::get<map_store::Store>(opened);
    for (const std::uint32_t id : {0U, 1U}) {
      const auto put = store.put("car", testing::example_submap(id, 0, 20));
      require(put == map_store::PutResult::kStored, "the example is stored");
      require(store.add_traffic("car", {5}, {id}, testing::example_streams()),
              "its traffic is stored");
    }
  }
  return file_content(file);
}

}  // namespace

void read_checkpoint(std::string_view bytes) {
  static testing::SimulatedDrive drive = room_drive();
  static const std::string example = example_checkpoint();
  static const auto scan = drive.scan(10);
  localization::Localizer localizer(small_map());
  if (!localizer.restore(sealed(edited(example, bytes)))) return;
  localizer.add_odometry(drive.odometry(10));
  if (const auto localized = localizer.localize(scan))
    localizer.integrate(testing::all_stationary(*localized));
  localizer.checkpoint();
}

void read_submap(std::string_view bytes) {
  static const std::string example =
      unpacked(map_store::to_blob(testing::example_submap(1, 0, 20)));
  for (const std::string& blob :
       {std::string(bytes), packed(bytes), packed(edited(example, bytes))}) {
    if (const auto submap = map_store::from_blob(blob)) require_usable(*submap);
  }
}

void read_submap_traffic(std::string_view bytes) {
  static const std::string example =
      unpacked(map_store::to_traffic_blob(testing::example_streams()));
  for (const std::string& blob :
       {std::string(bytes), packed(bytes), packed(edited(example, bytes))}) {
    if (const auto streams = map_store::from_traffic_blob(blob)) require_usable(*streams);
  }
}

void read_map_database(std::string_view bytes) {
  static const bool is_in_memory = setenv("TMPDIR", "/dev/shm", 0) == 0;  // no disk to wait for
  static const testing::TemporaryFolder folder;
  static const std::string example = example_database();
  require(is_in_memory, "the environment takes a variable");
  const auto file = folder / "map.sqlite";
  for (const char* suffix : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + suffix);
  std::ofstream(file, std::ios::binary) << edited(example, bytes);
  auto opened = map_store::Store::open(file, {});
  if (const auto* fault = std::get_if<std::string>(&opened)) return require_one_line(*fault);
  auto& store = std::get<map_store::Store>(opened);
  for (const std::string& vehicle : store.vehicles()) {
    (void)store.maps(vehicle);
    for (const map_store::Store::StoredMap& map : store.maps(vehicle)) {
      for (const auto& stored : store.traffic(vehicle, map.map_id)) {
        if (stored.streams) require_usable(*stored.streams);
      }
    }
    for (const flow::SubmapId id : store.list(vehicle)) {
      if (const auto submap = store.get(vehicle, id)) require_usable(*submap);
    }
  }
}

void read_client_message(std::string_view bytes) {
  const auto message = gateway::parse_client_message(bytes);
  if (const auto* refused = std::get_if<gateway::Refused>(&message))
    require(!refused->reason.empty(), "a refusal has a reason");
}

}  // namespace slammot::fuzz
