#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/bags/message_source.hpp"

namespace slammot::bags {

/// A bag that was opened, or why it was not.
struct OpenedBag {
  std::unique_ptr<MessageSource> messages;   ///< Null where there is a fault.
  std::string fault;
};

/// Whether the file begins as a bag does (.bag, .mcap, .db3, or packed by zstd) or is named as one, or the folder holds such files.
bool is_bag(const std::filesystem::path& path);

/// Opens a file by what it begins with, or all files of a folder, one after the other in the order of the numbers in their names.
/// Messages that are packed by zstd one by one (rosbag2's compression mode "message") are unpacked.
OpenedBag open_bag(const std::filesystem::path& path);

}  // namespace slammot::bags
