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

/// What a service needs to go on after a crash, and the stamp of the data that it was made from.
struct SavedState {
  std::int64_t stamp_ns = 0;
  std::vector<std::byte> bytes;
};

/// One file that always holds a whole state, the last one or the one before: written under another name by a thread of its
/// own and then renamed.
class StateFile {
 public:
  explicit StateFile(std::filesystem::path path);
  /// Finishes writing.
  ~StateFile();
  StateFile(const StateFile&) = delete;
  StateFile& operator=(const StateFile&) = delete;

  /// Nothing when there is none or it is damaged.
  std::optional<SavedState> read() const;

  /// Whether a state is still being written: saving another one now would be for nothing.
  bool is_busy() const;
  /// Returns at once. Of states that are saved while one is being written only the last one is kept.
  void save(SavedState state);
  /// Why the last state could not be written; empty when it could.
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
