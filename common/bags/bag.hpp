#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/bags/message_source.hpp"

namespace slammot::bags {

/// An opened bag, or the fault.
struct OpenedBag {
  std::unique_ptr<MessageSource> messages;  ///< Null if there is a fault.
  std::string fault;
};

/// True if the file has a bag's magic bytes (.bag, .mcap, .db3, or zstd-compressed) or extension,
/// or if the folder holds such files.
bool is_bag(const std::filesystem::path& path);

/// Opens a file, whose format follows from its first bytes, or all files of a folder in the order
/// of the numbers in their names. Messages compressed one by one with zstd (rosbag2's compression
/// mode "message") are unpacked.
OpenedBag open_bag(const std::filesystem::path& path);

}  // namespace slammot::bags
