#pragma once

#include <memory>
#include <utility>

#include "common/files/record_source.hpp"

namespace slammot::files {

/// Records of another source, changed on their way; what it says of itself stays as it is.
class RecordFilter : public RecordSource {
 public:
  std::uint64_t line_number() const override { return records_->line_number(); }
  double fraction_read() const override { return records_->fraction_read(); }
  std::uint64_t overlong_lines() const override { return records_->overlong_lines(); }
  bool last_line_is_unfinished() const override { return records_->last_line_is_unfinished(); }
  std::uint64_t repeated_scans() const override { return records_->repeated_scans(); }
  bool is_cut() const override { return records_->is_cut(); }
  std::string damage() const override { return records_->damage(); }
  TopicChoice topics() const override { return records_->topics(); }

 protected:
  explicit RecordFilter(std::unique_ptr<RecordSource> records) : records_(std::move(records)) {}
  RecordSource& records() { return *records_; }

 private:
  std::unique_ptr<RecordSource> records_;
};

}  // namespace slammot::files
