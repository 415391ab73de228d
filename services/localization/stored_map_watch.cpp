#include "services/localization/stored_map_watch.hpp"

#include <cmath>
#include <sstream>

namespace slammot::localization {
namespace {

constexpr double kSameSize = 1e-6;  // of a cell: what was stored is the same number

std::string metres(double length_m) {
  std::ostringstream text;
  text << length_m << " m";
  return text.str();
}

std::string out_of(std::uint64_t some, std::uint64_t all) {
  return std::to_string(some) + " of " + std::to_string(all);
}

std::uint64_t numbers_in_use(const flow::StoredMap& map) {
  return std::uint64_t{map.last_submap_id.value} + 1;
}

}  // namespace

void StoredMapWatch::is_stored(const flow::StoredMap& map, std::int64_t now_ns) {
  stored_ = map;
  last_progress_ns_ = now_ns;
}

void StoredMapWatch::is_placed(const flow::GraphCorrection& correction, std::int64_t now_ns) {
  placed_ = correction;
  last_progress_ns_ = now_ns;
}

void StoredMapWatch::is_on_its_way(flow::MapId map_id, flow::SubmapId submap_id,
                                   std::int64_t now_ns) {
  const Submap submap{map_id, submap_id};
  if (on_its_way_ == submap) return;
  on_its_way_ = submap;
  last_progress_ns_ = now_ns;
}

/// What no waiting makes good; empty where all is well.
std::string StoredMapWatch::fault() const {
  const std::uint64_t all = numbers_in_use(*stored_);
  if (stored_->unreadable > 0) return out_of(stored_->unreadable, all) + " submaps are damaged";
  if (stored_->submaps < all) return out_of(all - stored_->submaps, all) + " submaps are missing";
  if (std::abs(stored_->cell_size_m - cell_size_m_) > kSameSize * cell_size_m_) {
    return "it is of another profile, with cells of " + metres(stored_->cell_size_m) + " for " +
           metres(cell_size_m_) + " here";
  }
  return {};
}

/// What may still come; empty where nothing is missing.
std::string StoredMapWatch::missing() const {
  if (!stored_) return "map_store has not said what it has";
  const bool has_it = !on_its_way_ || (on_its_way_->map_id == stored_->map_id &&
                                       on_its_way_->submap_id <= stored_->last_submap_id);
  if (!has_it) return "the end of the drive before is not stored yet";
  const bool is_of_it = placed_ && placed_->map_id == stored_->map_id && !placed_->submaps.empty();
  const std::uint64_t placed = is_of_it ? placed_->submaps.size() : 0;
  const bool is_whole = is_of_it && placed_->submaps.back().submap_id == stored_->last_submap_id;
  return is_whole ? "" : "loop closing has placed " + out_of(placed, stored_->submaps) + " submaps";
}

StoredMapWatch::Answer StoredMapWatch::answer(std::int64_t now_ns) const {
  const bool is_empty = stored_ && stored_->submaps == 0 && stored_->unreadable == 0;
  if (is_empty && !on_its_way_) return {Verdict::kNothingStored, ""};
  if (stored_ && !is_empty) {
    if (const std::string wrong = fault(); !wrong.empty()) return {Verdict::kCannot, wrong};
  }
  const std::string wait_for = missing();
  if (wait_for.empty()) return {Verdict::kGoOn, ""};
  return {now_ns - last_progress_ns_ < patience_ns_ ? Verdict::kWait : Verdict::kCannot, wait_for};
}

}  // namespace slammot::localization
