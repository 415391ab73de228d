#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace slammot::files {

/// Lines of text one after the other, wherever they come from.
class LineSource {
 public:
  virtual ~LineSource() = default;

  /// The next line without its end, valid until the next call; nullopt at the end of what can be read.
  virtual std::optional<std::string_view> next() = 0;

  /// Of the line last returned, from 1.
  virtual std::uint64_t line_number() const = 0;

  /// Share taken in so far, [0, 1].
  virtual double fraction_read() const = 0;

  /// Lines that were too long to be returned.
  virtual std::uint64_t overlong_lines() const { return 0; }

  /// Whether the last line returned had no line end: the text may have been cut there.
  virtual bool last_line_is_unfinished() const { return false; }

  /// Whether the text is known to go on where it could not be read.
  virtual bool is_cut() const { return false; }
};

}  // namespace slammot::files
