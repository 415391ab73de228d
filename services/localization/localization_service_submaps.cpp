#include "services/localization/localization_service_submaps.hpp"

#include <algorithm>

#include "common/wire/text.hpp"

namespace slammot::localization {

SubmapPublisher::SubmapPublisher(app::ServiceContext& context)
    : context_(context), tiles_(context.write(dds::topics::kSubmapTile)) {}

void SubmapPublisher::publish(const flow::Submap& submap) {
  constexpr int kAttempts = 20;  // while a reader is slow
  std::uint32_t& tiles = tiles_of_[submap.submap_id] = 0;
  encoder_.encode(context_.vehicle_id(), submap, [&](const slammot_SubmapTile& tile) {
    int attempts = 0;
    while (tiles_.write(tile) == dds::WriteResult::kTimedOut && ++attempts < kAttempts) {}
    if (attempts == kAttempts)
      context_.warn("lost_tiles", "a reader is slow: a submap tile was not sent");
    ++tiles;
  });
  newest_ = std::max(submap.submap_id, newest_.value_or(submap.submap_id));
  ++context_.status().counter("published_submaps");
}

void SubmapPublisher::end_tiles(flow::SubmapId submap_id, std::uint32_t tiles) {
  slammot_SubmapTile key{};
  wire::set_text(key.vehicle_id, context_.vehicle_id());
  key.submap_id = submap_id.value;
  for (key.tile_index = 0; key.tile_index < tiles; ++key.tile_index) tiles_.end(key);
}

void SubmapPublisher::withdraw() {
  for (const auto& [submap_id, tiles] : tiles_of_) end_tiles(submap_id, tiles);
  tiles_of_.clear();
  newest_.reset();
}

void SubmapPublisher::release(const flow::StoredMap& stored) {
  if (stored.submaps != stored.last_submap_id.value + 1) return;
  std::erase_if(tiles_of_, [&](const auto& of_submap) {
    if (of_submap.first > stored.last_submap_id) return false;
    end_tiles(of_submap.first, of_submap.second);
    return true;
  });
}

std::optional<flow::SubmapId> SubmapPublisher::newest() const { return newest_; }

}  // namespace slammot::localization
