#include "services/ingest/drive_mark.hpp"

#include <fstream>
#include <optional>

namespace slammot::ingest {
namespace {

std::optional<std::uint64_t> recorded_drive(const std::filesystem::path& file,
                                            const std::string& log) {
  std::ifstream stream(file);
  std::string recorded_log;
  std::uint64_t drive_id = 0;
  if (!std::getline(stream, recorded_log) || recorded_log != log || !(stream >> drive_id))
    return std::nullopt;
  return drive_id;
}

}  // namespace

DriveMark::DriveMark(std::filesystem::path file, const std::string& log, std::uint64_t new_id)
    : file_(std::move(file)), drive_id_(recorded_drive(file_, log).value_or(new_id)) {
  std::error_code ignored_fault;
  if (file_.has_parent_path())
    std::filesystem::create_directories(file_.parent_path(), ignored_fault);
  std::ofstream(file_) << log << '\n' << drive_id_ << '\n';
}

DriveMark::~DriveMark() {
  std::error_code ignored_fault;
  std::filesystem::remove(file_, ignored_fault);
}

}  // namespace slammot::ingest
