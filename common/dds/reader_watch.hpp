#pragma once

#include <cstdint>
#include <set>

#include "common/dds/writer.hpp"

namespace slammot::dds {

/// Notices readers that join a writer.
class ReaderWatch {
 public:
  /// The writer must outlive the watch.
  explicit ReaderWatch(const WriterBase& writer) : writer_(writer) {}

  /// True if readers are connected that were not at the last call.
  bool has_new();

 private:
  const WriterBase& writer_;
  std::set<std::uint64_t> known_;  ///< Handles of connected readers.
};

}  // namespace slammot::dds
