#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace slammot::ingest {

/// The drive that this process is playing, noted in a file: after a crash the next process goes on
/// with the same drive. One that ends or is stopped leaves no mark, so that what comes after it is
/// a new drive, be it the same log.
class DriveMark {
 public:
  /// Takes up the drive in the file if it is of this log, otherwise begins `new_id`. A folder that
  /// cannot be written leaves the drive unmarked: after a crash it begins anew.
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
