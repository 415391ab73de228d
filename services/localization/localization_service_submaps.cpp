#include "services/localization/localization_service_submaps.hpp"

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
  ++context_.status().counter("published_submaps");
}

void SubmapPublisher::withdraw() {
  slammot_SubmapTile key{};
  wire::set_text(key.vehicle_id, context_.vehicle_id());
  for (const auto& [submap_id, tiles] : tiles_of_) {
    key.submap_id = submap_id.value;
    for (key.tile_index = 0; key.tile_index < tiles; ++key.tile_index) tiles_.end(key);
  }
  tiles_of_.clear();
}

std::optional<flow::SubmapId> SubmapPublisher::newest() const {
  return tiles_of_.empty() ? std::nullopt : std::optional(tiles_of_.rbegin()->first);
}

}  // namespace slammot::localization
