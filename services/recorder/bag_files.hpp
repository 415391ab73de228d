#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "common/mcap/file.hpp"
#include "common/mcap/packer.hpp"
#include "services/recorder/topic_selection.hpp"

namespace slammot::recorder {

/// What was written, or why nothing was.
struct WrittenBag {
  std::uint64_t messages = 0;
  std::string fault;  ///< Empty on success.
};

/// What of the files goes into another one.
struct BagSelection {
  TopicSelection topics{};
  std::int64_t from_ns = std::numeric_limits<std::int64_t>::min();  ///< Log time, inclusive.
  std::int64_t to_ns = std::numeric_limits<std::int64_t>::max();    ///< Log time, inclusive.
};

/// Writes the selected messages of the files, by their log times, with all attachments and
/// metadata. Equal channels of several files become one; messages keep their sequence numbers.
WrittenBag write_bag(const std::vector<const mcap::File*>& files, const BagSelection& selection,
                     const std::filesystem::path& output, mcap::Compression compression);

/// Writes all sound chunks as they are, with new indexes and an end: of a file that a crash cut, or
/// that is damaged.
WrittenBag recover_bag(const mcap::File& file, const std::filesystem::path& output);

}  // namespace slammot::recorder
