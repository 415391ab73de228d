#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace slammot::app {

/// State that a service needs after a crash, with the stamp of its data.
struct SavedState {
  std::int64_t stamp_ns = 0;
  std::vector<std::byte> bytes;
};

/// A file that always holds a complete state, the last one or the one before: a thread writes it
/// under another name and renames it.
class StateFile {
 public:
  explicit StateFile(std::filesystem::path path);
  /// Waits for the end of writing.
  ~StateFile();
  StateFile(const StateFile&) = delete;
  StateFile& operator=(const StateFile&) = delete;

  /// None if the file is missing or damaged.
  std::optional<SavedState> read() const;

  /// True while a state is being written: another save would be in vain.
  bool is_busy() const;
  /// Returns at once. Of states saved during a write only the last one is kept.
  void save(SavedState state);
  /// Error of the last write; empty if it succeeded.
  std::string fault() const;

 private:
  void write_states();
  std::string write(const SavedState& state) const;

  std::filesystem::path path_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<SavedState> next_;
  bool is_writing_ = false;
  bool is_closing_ = false;
  std::string fault_;
  std::thread thread_;
};

}  // namespace slammot::app
