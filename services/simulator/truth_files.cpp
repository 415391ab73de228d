#include "services/simulator/truth_files.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "services/simulator/drive_text.hpp"

namespace slammot::simulator {
namespace {

constexpr std::int64_t kHiddenNs = 10'000'000'000;

std::filesystem::path with_ending(std::filesystem::path prefix, const char* ending) {
  return prefix += ending;
}

std::ofstream open(const std::filesystem::path& path) {
  return std::ofstream(path, std::ios::binary | std::ios::trunc);
}

}  // namespace

TruthFiles::TruthFiles(const std::filesystem::path& prefix,
                       const simulation::Outline& stationary_in_world, HitsFile hits)
    : tum_path_(with_ending(prefix, ".tum")),
      objects_path_(with_ending(prefix, ".objects.csv")),
      walls_path_(with_ending(prefix, ".walls.csv")),
      tum_(open(tum_path_)),
      objects_(open(objects_path_)),
      walls_(open(walls_path_)) {
  objects_ << objects_header();
  walls_ << wall_lines(stationary_in_world);
  if (hits == HitsFile::left_out) return;
  hits_ = open(with_ending(prefix, ".hits.csv"));
  *hits_ << hits_header();
}

void TruthFiles::add(const simulation::SimulatedScan& drive) {
  if (hits_) *hits_ << hits_line(drive);
  if (drive.is_vertical) return;
  if (newest_ && newest_->scan.stamp_ns != drive.scan.stamp_ns) write_newest();
  newest_ = with_all_scanners(drive);
}

/// The scan with the objects that it or the latest scan of another scanner hit, and the sum of
/// their beams; after them those that were hit within kHiddenNs, without beams.
simulation::SimulatedScan TruthFiles::with_all_scanners(const simulation::SimulatedScan& drive) {
  std::map<int, int>& own = points_by_scanner_[drive.scanner];
  own.clear();
  for (const simulation::ObjectTruth& object : drive.objects) own[object.id] = object.points;
  simulation::SimulatedScan seen;
  seen.scan.stamp_ns = drive.scan.stamp_ns;
  seen.world_from_base = drive.world_from_base;
  std::vector<simulation::ObjectTruth> hidden;
  const auto add = [&](simulation::ObjectTruth object) {
    object.points = 0;
    for (const auto& [scanner, points] : points_by_scanner_)
      object.points += points.contains(object.id) ? points.at(object.id) : 0;
    if (object.points > 0) last_hit_ns_[object.id] = drive.scan.stamp_ns;
    const auto hit = last_hit_ns_.find(object.id);
    if (hit != last_hit_ns_.end() && drive.scan.stamp_ns - hit->second <= kHiddenNs)
      (object.points > 0 ? seen.objects : hidden).push_back(object);
  };
  std::ranges::for_each(drive.objects, add);
  std::ranges::for_each(drive.unseen, add);
  seen.objects.insert(seen.objects.end(), hidden.begin(), hidden.end());
  return seen;
}

void TruthFiles::write_newest() {
  tum_ << tum_line(*newest_);
  objects_ << object_lines(*newest_);
  if (last_)
    distance_m_ += (newest_->world_from_base.translation_m() - last_->translation_m()).norm();
  last_ = newest_->world_from_base;
  newest_.reset();
}

std::optional<std::string> TruthFiles::close() {
  if (newest_) write_newest();
  for (std::ofstream* file : {&tum_, &objects_, &walls_, hits_ ? &*hits_ : nullptr}) {
    if (file) file->close();
    if (file && !*file)
      return "cannot write all of the truth into " + tum_path_.parent_path().string();
  }
  return std::nullopt;
}

}  // namespace slammot::simulator
