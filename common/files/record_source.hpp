#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/files/carmen_record.hpp"
#include "common/files/line_source.hpp"
#include "common/files/topic_choice.hpp"

namespace slammot::files {

/// What sensors said, one record after the other, whatever the form of the log.
class RecordSource {
 public:
  virtual ~RecordSource() = default;

  /// The next record, valid until the next call; nullopt at the end of what can be read.
  virtual std::optional<CarmenRecord> next() = 0;

  /// Of the record last returned, from 1: its line, or its message among those of a bag that are of use.
  virtual std::uint64_t line_number() const = 0;

  /// Share taken in so far, [0, 1].
  virtual double fraction_read() const = 0;

  /// Lines that were too long to be returned.
  virtual std::uint64_t overlong_lines() const { return 0; }

  /// Whether the last record had no end: the text may have been cut there.
  virtual bool last_line_is_unfinished() const { return false; }

  /// Whether the log is known to go on where it could not be read.
  virtual bool is_cut() const { return false; }

  /// What is damaged and where, as far as it is known: "the chunk at byte 1234 does not unpack".
  virtual std::string damage() const { return {}; }

  /// Which topics were chosen from which; empty where the form of the log leaves no choice.
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
