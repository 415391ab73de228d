#include "common/app/drive_mark.hpp"

#include <fstream>
#include <utility>

namespace slammot::app {
namespace {

struct Mark {
  std::uint64_t drive_id = 0;
  std::optional<std::int64_t> noted_ns;
};

std::optional<Mark> recorded(const std::filesystem::path& file, const std::string& log) {
  std::ifstream stream(file);
  std::string recorded_log;
  Mark mark;
  std::int64_t noted_ns = 0;
  if (!std::getline(stream, recorded_log) || recorded_log != log || !(stream >> mark.drive_id))
    return std::nullopt;
  if (stream >> noted_ns) mark.noted_ns = noted_ns;
  return mark;
}

}  // namespace

DriveMark::DriveMark(std::filesystem::path file, const std::string& log, std::uint64_t new_id)
    : file_(std::move(file)), log_(log), drive_id_(new_id) {
  if (const auto mark = recorded(file_, log)) {
    drive_id_ = mark->drive_id;
    noted_ns_ = mark->noted_ns;
  }
  std::error_code ignored_fault;
  if (file_.has_parent_path())
    std::filesystem::create_directories(file_.parent_path(), ignored_fault);
  write(noted_ns_ ? std::to_string(*noted_ns_) : "");
}

void DriveMark::note(std::int64_t stamp_ns) { write(std::to_string(stamp_ns)); }

/// Renames a complete file, so that a kill meanwhile does not end the drive.
void DriveMark::write(const std::string& progress) const {
  const std::filesystem::path unfinished = file_.string() + ".unfinished";
  std::ofstream(unfinished) << log_ << '\n' << drive_id_ << '\n' << progress << '\n';
  std::error_code ignored_fault;
  std::filesystem::rename(unfinished, file_, ignored_fault);
}

DriveMark::~DriveMark() {
  std::error_code ignored_fault;
  std::filesystem::remove(file_, ignored_fault);
}

}  // namespace slammot::app
