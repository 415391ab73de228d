// How the state of a tracker is saved and restored.
#include <algorithm>
#include <utility>

#include "services/tracking/state_parts.hpp"
#include "services/tracking/tracker.hpp"

namespace slammot::tracking {
namespace {

constexpr std::uint64_t kMark = 0x747261636b657231;  // "tracker1": the digit counts the forms

/// False for a track that refers to a scanner which is none.
bool is_sound(const Track& track, std::size_t scanners) {
  for (const PastPoints& past : track.history.past_points.all()) {
    if (past.scanner >= scanners) return false;
  }
  return track.history.scanner < scanners;
}

}  // namespace

void Tracker::visit_state(auto& self, auto& visit) {
  visit(self.counters_, self.tracks_, self.scanners_, self.estimation_, self.next_id_);
}

bool Tracker::is_sound() const {
  return scanners_.is_sound() && estimation_.associator.is_sound() &&
         estimation_.formations.is_sound_with(tracks_) &&
         std::ranges::all_of(tracks_, [this](const Track& track) {
           return tracking::is_sound(track, scanners_.count());
         });
}

void Tracker::save(std::vector<std::byte>& bytes) const {
  memory::put(bytes, kMark);
  save_state<StateParts>(bytes, *this);
}

bool Tracker::restore(std::span<const std::byte> bytes) {
  memory::ByteReader from(bytes);
  std::uint64_t mark = 0;
  from.get(mark);
  if (mark != kMark) return false;
  Tracker loaded(config_);
  load_state<StateParts>(from, loaded);
  if (!from.ok() || !from.at_end() || !loaded.is_sound()) return false;
  for (Scanner& scanner : loaded.scanners_.all()) scanner.history.measure_depths();
  for (Track& track : loaded.tracks_)
    track.extent.footprint().road_users = &loaded.estimation_.road_users.known();
  counters_ = loaded.counters_;
  tracks_ = std::move(loaded.tracks_);
  scanners_ = std::move(loaded.scanners_);
  estimation_ = std::move(loaded.estimation_);
  next_id_ = loaded.next_id_;
  return true;
}

}  // namespace slammot::tracking
