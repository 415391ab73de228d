#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/line_source.hpp"
#include "common/files/result.hpp"

struct gzFile_s;

namespace slammot::files {

/// Reads a text file line by line, plain or gzip-compressed as its first bytes show. While the
/// lines of one chunk are returned, another thread decompresses the next one.
class LineReader : public LineSource {
 public:
  /// Longer lines are skipped and counted: no scanner's record is that long.
  static constexpr std::size_t kMaxLineBytes = 1 << 20;

  /// Fails if the file is missing, unreadable or not a regular file.
  static Result<LineReader> open(const std::filesystem::path& path);

  /// The next line without its end ("\n" or "\r\n"), valid until the next call; nullopt at the end
  /// of the readable part.
  std::optional<std::string_view> next() override;

  /// Number of the last returned line, from 1.
  std::uint64_t line_number() const override { return line_number_; }
  std::uint64_t overlong_lines() const override { return overlong_lines_; }

  /// True if the last returned line had no line end: the file may be truncated.
  bool last_line_is_unfinished() const override { return last_line_is_unfinished_; }

  /// True if the compressed data ended too early or were damaged: the rest of the file is
  /// unreadable.
  bool is_cut() const override { return is_cut_; }

  /// Share of the file's bytes taken in so far, [0, 1].
  double fraction_read() const override;

 private:
  struct Close {
    void operator()(gzFile_s* file) const;
  };

  /// Result of one call of zlib.
  struct Unpacked {
    std::vector<char> text;
    std::size_t bytes = 0;          ///< Of the text.
    std::uintmax_t bytes_read = 0;  ///< Of the file so far.
    bool is_cut = false;
  };

  explicit LineReader(std::unique_ptr<gzFile_s, Close> file, std::uintmax_t file_bytes);
  static Unpacked unpack(gzFile_s* file, std::vector<char> into);
  void unpack_ahead(std::vector<char> into);
  bool fill();
  void keep(std::string_view piece);
  std::optional<std::string_view> finish_line(std::string_view piece);

  std::unique_ptr<gzFile_s, Close> file_;
  std::uintmax_t file_bytes_ = 0;
  Unpacked chunk_;
  std::size_t begin_ = 0;  // start of the unreturned part of chunk_
  std::size_t end_ = 0;
  std::string partial_;  // beginning of a line that continues in the next chunk
  bool skips_line_ = false;
  std::uint64_t line_number_ = 0;
  std::uint64_t overlong_lines_ = 0;
  bool last_line_is_unfinished_ = false;
  bool is_cut_ = false;
  std::future<Unpacked> next_chunk_;  // last: it must end before the file is closed
};

}  // namespace slammot::files
