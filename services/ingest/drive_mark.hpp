#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace slammot::ingest {

/// File with the id of the drive that this process plays. After a crash the next process continues
/// the drive. A process that ends or is stopped removes the file, so that its successor begins a
/// new drive, even for the same log.
class DriveMark {
 public:
  /// Continues the drive in the file if it is of this log; otherwise begins `new_id`. If the folder
  /// is not writable, a drive does not continue after a crash.
  DriveMark(std::filesystem::path file, const std::string& log, std::uint64_t new_id);
  ~DriveMark();
  DriveMark(const DriveMark&) = delete;
  DriveMark& operator=(const DriveMark&) = delete;

  std::uint64_t drive_id() const { return drive_id_; }

 private:
  std::filesystem::path file_;
  std::uint64_t drive_id_;
};

}  // namespace slammot::ingest
