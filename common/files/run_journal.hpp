#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "common/files/run_record.hpp"

namespace slammot::files {

/// A scan that was on the bus.
struct JournalScan {
  std::string scanner_id;
  std::uint64_t drive_id = 0;
  std::uint32_t sequence = 0;
  std::int64_t stamp_ns = 0;
};

/// What was taken so far of one drive while it is driven, a line at a time: whoever is started again goes on from here. Submaps,
/// constraints and corrections are not in it; those who make them keep them.
class RunJournal {
 public:
  /// Appends to the file; nothing is written before begin() or resume().
  explicit RunJournal(std::filesystem::path file) : file_(std::move(file)) {}

  /// Forgets what is in the file.
  void begin(flow::MapId map_id, flow::OdomId odom_id);
  /// Keeps what is in the file.
  void resume();
  /// The work is done.
  void remove();

  void add(const JournalScan& scan);
  void add(const flow::LocalizedScan& scan);
  void add(const flow::TrackedObjects& tracked);

  struct Content {
    flow::MapId map_id;
    flow::OdomId odom_id;
    std::vector<JournalScan> scans;
    std::vector<flow::LocalizedScan> localized_scans;    ///< Without their beams.
    std::vector<flow::TrackedObjects> tracked_objects;   ///< With what a track's row shows.
  };
  /// None where there is no journal. A line that was being written at the end is left out.
  static std::optional<Content> read(const std::filesystem::path& file);

 private:
  std::filesystem::path file_;
  std::ofstream stream_;
};

}  // namespace slammot::files
