#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/files/run_record.hpp"

namespace slammot::files {

/// What localization calls a drive.
struct DriveName {
  flow::MapId map_id;
  flow::OdomId odom_id;
  auto operator<=>(const DriveName&) const = default;
};

/// A scan received from the bus.
struct JournalScan {
  std::string scanner_id;
  std::uint64_t drive_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t stamp_ns = 0;
};

/// Journal of a drive while it is recorded, one line at a time: a restarted process continues from
/// it. Submaps, constraints and corrections are kept by the services that create them.
class RunJournal {
 public:
  /// Appends to the file; nothing is written before begin() or resume().
  explicit RunJournal(std::filesystem::path file) : file_(std::move(file)) {}

  /// Clears the file. ended: drives before this one.
  void begin(const DriveName& drive, std::span<const DriveName> ended = {});
  /// Continues the file.
  void resume();
  /// Removes the journal of a finished drive.
  void remove();

  void add(const JournalScan& scan);
  void add(const flow::LocalizedScan& scan);
  void add(const flow::TrackedObjects& tracked);

  struct Content {
    DriveName drive;
    std::vector<DriveName> ended;  ///< Drives before this one.
    std::vector<JournalScan> scans;
    std::vector<flow::LocalizedScan> localized_scans;   ///< Without their beams.
    std::vector<flow::TrackedObjects> tracked_objects;  ///< Fields of a track's row only.
  };
  /// None if there is no journal. An incomplete last line is ignored.
  static std::optional<Content> read(const std::filesystem::path& file);

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
};

}  // namespace slammot::files
