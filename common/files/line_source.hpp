#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace slammot::files {

/// A sequence of text lines from any source.
class LineSource {
 public:
  virtual ~LineSource() = default;

  /// The next line without its end, valid until the next call; nullopt at the end of what can be
  /// read.
  virtual std::optional<std::string_view> next() = 0;

  /// Number of the last returned line, from 1.
  virtual std::uint64_t line_number() const = 0;

  /// Share taken in so far, [0, 1].
  virtual double fraction_read() const = 0;

  /// Number of lines too long to be returned.
  virtual std::uint64_t overlong_lines() const { return 0; }

  /// True if the last returned line had no line end: the text may be truncated.
  virtual bool last_line_is_unfinished() const { return false; }

  /// True if the text continues beyond an unreadable place.
  virtual bool is_cut() const { return false; }
};

}  // namespace slammot::files
