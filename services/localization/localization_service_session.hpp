#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/app/state_file.hpp"
#include "services/localization/localizer.hpp"
#include "services/localization/saved_session.hpp"

namespace slammot::localization {

struct StampedSession {
  std::int64_t stamp_ns = 0;
  SavedSession session;
};

/// The checkpoint of a session as a file, written once a second by the clock of the data, and at
/// most four times a second.
class SessionFile {
 public:
  explicit SessionFile(std::filesystem::path path) : file_(std::move(path)) {}

  /// The session of the process before; none if there was none or it is of another version, and at
  /// every later call.
  std::optional<StampedSession> look_back();

  /// The session that is in the file now; none if there is none or it is of another version.
  std::optional<StampedSession> read() const;

  /// True if a session of this stamp is due; now_ns by a clock that never goes back.
  bool is_due(std::int64_t stamp_ns, std::int64_t now_ns) const;
  /// True while a session is being written.
  bool is_busy() const { return file_.is_busy(); }
  /// Copies the localizer, of a drive that has begun, and returns; the file's thread makes the
  /// bytes of it and of `session`, and writes them. Not while busy.
  void save(std::int64_t stamp_ns, std::int64_t now_ns, SavedSession session,
            const Localizer& localizer);

  /// The same with the mark that the process ended in order, also while busy. The file writes it
  /// before it is destroyed.
  void save_last(std::int64_t stamp_ns, SavedSession session, const Localizer& localizer);

  /// Makes the next session due at once.
  void begin_drive() { saved_ns_.reset(); }

  /// Error of the last write; empty if it succeeded.
  std::string fault() const { return file_.fault(); }

 private:
  struct Unwritten {
    SavedSession session;
    LocalizerSnapshot localizer;
  };

  app::StateFile file_;
  bool has_looked_back_ = false;
  std::optional<std::int64_t> saved_ns_;
  std::int64_t last_time_ns_ = 0;    ///< When that was.
  std::shared_ptr<Unwritten> last_;  ///< Kept for its memory.
};

}  // namespace slammot::localization
