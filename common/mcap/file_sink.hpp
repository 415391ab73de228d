#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/bags/byte_reader.hpp"

namespace slammot::mcap {

/// A new file that is written from its beginning to its end. A fault stays: no later call writes.
class FileSink {
 public:
  /// Creates the file. An existing one is a fault, and stays as it is.
  explicit FileSink(const std::filesystem::path& path);
  ~FileSink();
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  /// False on a fault, such as a full disk; a part of the bytes may be in the file then.
  bool write(bags::Bytes bytes);
  /// Takes back what was written after this position, and the fault.
  bool cut_to(std::uint64_t position);
  /// Waits until the file is on the disk, and closes it. False on a fault.
  bool close();

  std::uint64_t position() const { return position_; }
  /// One line: "PATH: No space left on device"; empty without a fault.
  const std::string& fault() const { return fault_; }

 private:
  bool fail(int error);

  std::filesystem::path path_;
  int file_ = -1;
  std::uint64_t position_ = 0;
  std::string fault_;
};

}  // namespace slammot::mcap
