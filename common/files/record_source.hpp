#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/files/carmen_record.hpp"
#include "common/files/line_source.hpp"
#include "common/files/topic_choice.hpp"

namespace slammot::files {

/// A sequence of sensor records, independent of the log's format.
class RecordSource {
 public:
  virtual ~RecordSource() = default;

  /// The next record, valid until the next call; nullopt at the end of what can be read.
  virtual std::optional<CarmenRecord> next() = 0;

  /// Number of the last returned record, from 1: its line, or its index among the used messages of
  /// a bag.
  virtual std::uint64_t line_number() const = 0;

  /// Share taken in so far, [0, 1].
  virtual double fraction_read() const = 0;

  /// Number of lines too long to be returned.
  virtual std::uint64_t overlong_lines() const { return 0; }

  /// True if the last record had no end: the text may be truncated.
  virtual bool last_line_is_unfinished() const { return false; }

  /// Number of scans left out so far because they were recorded again.
  virtual std::uint64_t repeated_scans() const { return 0; }

  /// True if the log continues beyond an unreadable place.
  virtual bool is_cut() const { return false; }

  /// Kind and place of the damage, if known: "the chunk at byte 1234 does not unpack".
  virtual std::string damage() const { return {}; }

  /// Available and chosen topics; empty if the format leaves no choice.
  virtual TopicChoice topics() const { return {}; }
};

/// Lines of text as records.
class CarmenLines : public RecordSource {
 public:
  explicit CarmenLines(std::unique_ptr<LineSource> lines) : lines_(std::move(lines)) {}

  std::optional<CarmenRecord> next() override {
    const auto line = lines_->next();
    return line ? std::optional(parse_carmen_line(*line)) : std::nullopt;
  }
  std::uint64_t line_number() const override { return lines_->line_number(); }
  double fraction_read() const override { return lines_->fraction_read(); }
  std::uint64_t overlong_lines() const override { return lines_->overlong_lines(); }
  bool last_line_is_unfinished() const override { return lines_->last_line_is_unfinished(); }
  bool is_cut() const override { return lines_->is_cut(); }

 private:
  std::unique_ptr<LineSource> lines_;
};

}  // namespace slammot::files
