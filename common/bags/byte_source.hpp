#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "common/bags/byte_reader.hpp"

struct ZSTD_DCtx_s;

namespace slammot::bags {

/// The bytes of a file one after the other, unpacked where the whole file is packed by zstd (as
/// rosbag2's compression mode "file" does), with memory for what was asked for only.
class ByteSource {
 public:
  explicit ByteSource(const std::filesystem::path& path);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;

  /// Up to so many bytes into the buffer, in place of what it holds; fewer at the end. A size that
  /// is not true costs no memory beyond what is there.
  void read(std::uint64_t count, std::vector<std::uint8_t>& into);

  /// False where the end comes before.
  bool skip(std::uint64_t count);

  /// Of the bytes handed out so far, unpacked.
  std::uint64_t position() const { return position_; }

  /// Share of the file taken in so far, [0, 1].
  double fraction_read() const;

  /// Whether packed bytes were damaged or ended too early.
  bool is_damaged() const { return is_damaged_; }

  /// False for a file that could not be opened.
  bool is_open() const { return file_.is_open(); }

 private:
  struct Free {
    void operator()(ZSTD_DCtx_s* context) const;
  };

  std::size_t read_some(std::uint8_t* into, std::size_t count);
  std::size_t unpack_some(std::uint8_t* into, std::size_t count);

  std::ifstream file_;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t file_bytes_read_ = 0;
  std::uint64_t position_ = 0;
  bool is_damaged_ = false;
  std::unique_ptr<ZSTD_DCtx_s, Free> unpacks_;  ///< Null for a plain file.
  std::vector<std::uint8_t> packed_;
  std::size_t packed_at_ = 0;
  bool frame_is_open_ = false;
};

/// The first bytes of a file, fewer where it is shorter.
std::string first_bytes(const std::filesystem::path& path, std::size_t count);

/// What a frame of zstd begins with.
bool is_zstd(std::string_view first_bytes);

}  // namespace slammot::bags
