#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace slammot::app {

/// File with the id of the drive that this process plays or simulates, and how far it is. After a
/// crash the next process continues the drive. A process that ends or is stopped removes the file,
/// so that its successor begins a new drive, even for the same log.
class DriveMark {
 public:
  /// Continues the drive in the file if it is of this log; otherwise begins `new_id`. If the folder
  /// is not writable, a drive does not continue after a crash.
  DriveMark(std::filesystem::path file, const std::string& log, std::uint64_t new_id);
  ~DriveMark();
  DriveMark(const DriveMark&) = delete;
  DriveMark& operator=(const DriveMark&) = delete;

  std::uint64_t drive_id() const { return drive_id_; }
  /// Stamp that the process before noted last; none if it noted none, or the drive is new.
  std::optional<std::int64_t> noted_ns() const { return noted_ns_; }
  /// Notes progress, for a source that its consumers cannot ask for it.
  void note(std::int64_t stamp_ns);

 private:
  void write(const std::string& progress) const;

  std::filesystem::path file_;
  std::string log_;
  std::uint64_t drive_id_;
  std::optional<std::int64_t> noted_ns_;
};

}  // namespace slammot::app
