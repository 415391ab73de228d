#include "services/simulator/truth_files.hpp"

#include "services/simulator/drive_text.hpp"

namespace slammot::simulator {
namespace {

std::filesystem::path with_ending(std::filesystem::path prefix, const char* ending) { return prefix += ending; }

std::ofstream open(const std::filesystem::path& path) { return std::ofstream(path, std::ios::binary | std::ios::trunc); }

}  // namespace

TruthFiles::TruthFiles(const std::filesystem::path& prefix, const simulation::Outline& stationary_in_world, HitsFile hits)
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
  if (drive.scanner != 0) return;
  tum_ << tum_line(drive);
  objects_ << object_lines(drive);
  if (last_) distance_m_ += (drive.world_from_base.translation_m() - last_->translation_m()).norm();
  last_ = drive.world_from_base;
}

std::optional<std::string> TruthFiles::close() {
  for (std::ofstream* file : {&tum_, &objects_, &walls_, hits_ ? &*hits_ : nullptr}) {
    if (file) file->close();
    if (file && !*file) return "cannot write all of the truth into " + tum_path_.parent_path().string();
  }
  return std::nullopt;
}

}  // namespace slammot::simulator
