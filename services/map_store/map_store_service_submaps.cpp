#include "services/map_store/map_store_service_submaps.hpp"

#include <algorithm>
#include <chrono>

#include "common/wire/text.hpp"

namespace slammot::map_store {
namespace {

using namespace std::chrono_literals;

constexpr auto kTurn = 40ms;           // Longest time for which advance() sends.
constexpr auto kPatience = 1ms;        // For acknowledgements.
constexpr std::size_t kMostAhead = 8;  // Submaps sent to joining readers before they are received.

}  // namespace

StoredSubmaps::StoredSubmaps(app::ServiceContext& context, Store& store)
    : context_(context),
      store_(store),
      tiles_(context.write(dds::topics::kStoredSubmapTile)),
      readers_(tiles_) {}

/// False if a reader is slow: it lacks some tiles.
bool StoredSubmaps::write(const flow::Submap& submap) {
  std::uint32_t tiles = 0;
  bool all_written = true;
  encoder_.encode(context_.vehicle_id(), submap, [&](const slammot_SubmapTile& tile) {
    all_written = all_written && tiles_.write(tile) == dds::WriteResult::kWritten;
    ++tiles;
  });
  std::uint32_t& kept = kept_[submap.submap_id];
  kept = std::max(kept, tiles);
  if (!all_written) {
    due_.insert(submap.submap_id);
    context_.warn("slow_readers", "a reader of stored submaps is slow: publishes again later");
  }
  return all_written;
}

/// While older ones are sent, it waits for its turn: loop closing adds submaps in their order.
void StoredSubmaps::publish(const flow::Submap& submap) {
  if (due_.empty()) write(submap);
  else due_.insert(submap.submap_id);
}

void StoredSubmaps::withdraw() {
  end_kept();
  due_.clear();
}

void StoredSubmaps::end_kept() {
  slammot_SubmapTile key{};
  wire::set_text(key.vehicle_id, context_.vehicle_id());
  for (const auto& [submap_id, tiles] : kept_) {
    key.submap_id = submap_id.value;
    for (key.tile_index = 0; key.tile_index < tiles; ++key.tile_index) tiles_.end(key);
  }
  kept_.clear();
}

void StoredSubmaps::free_received() {
  if (!kept_.empty() && tiles_.wait_for_acknowledgements(kPatience)) end_kept();
}

void StoredSubmaps::advance() {
  const auto end = std::chrono::steady_clock::now() + kTurn;
  if (readers_.has_new()) {
    for (const flow::SubmapId id : store_.list(context_.vehicle_id())) due_.insert(id);
  }
  free_received();
  while (!due_.empty() && kept_.size() < kMostAhead && std::chrono::steady_clock::now() < end) {
    const flow::SubmapId id = *due_.begin();
    due_.erase(due_.begin());
    const auto submap = store_.get(context_.vehicle_id(), id);
    if (submap && !write(*submap)) break;
    free_received();
  }
}

}  // namespace slammot::map_store
