#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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
/// under another name and renames it. The thread gives way to those that process data.
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
  /// Returns at once; the file's thread makes the bytes. Of states saved during a write only the
  /// last one is kept.
  using MakeBytes = std::function<std::vector<std::byte>()>;
  void save(std::int64_t stamp_ns, MakeBytes make_bytes);
  void save(SavedState state);
  /// Error of the last write; empty if it succeeded.
  std::string fault() const;

 private:
  struct NextState {
    std::int64_t stamp_ns = 0;
    MakeBytes make_bytes;
  };

  void write_states();
  std::string write(const SavedState& state) const;

  std::filesystem::path path_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<NextState> next_;
  bool is_writing_ = false;
  bool is_closing_ = false;
  std::string fault_;
  std::thread thread_;
};

}  // namespace slammot::app
