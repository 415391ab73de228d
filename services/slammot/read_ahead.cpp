#include "services/slammot/read_ahead.hpp"

#include <utility>

namespace slammot {
namespace {

constexpr std::size_t kEventsPerBatch = 64;  // Passing single events would cost more than reading
                                             // them.
constexpr std::size_t kMaxBatches = 8;

}  // namespace

ReadAhead::ReadAhead(files::CarmenLog& log)
    : log_(log), thread_([this](const std::stop_token& stop) { read(stop); }) {}

ReadAhead::~ReadAhead() = default;

ReadAhead::Batch ReadAhead::read_batch() {
  Batch batch;
  batch.reserve(kEventsPerBatch);
  while (batch.size() < kEventsPerBatch) {
    auto event = log_.next();
    if (!event) break;
    batch.push_back({std::move(*event), log_.fraction_read()});
  }
  return batch;
}

void ReadAhead::read(const std::stop_token& stop) {
  bool has_ended = false;
  while (!has_ended && !stop.stop_requested()) {
    Batch batch = read_batch();
    has_ended = batch.empty();
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [&] { return ready_.size() < kMaxBatches; })) return;
    ready_.push_back(std::move(batch));
    changed_.notify_all();
  }
}

std::optional<ReadEvent> ReadAhead::next() {
  if (is_ended_) return std::nullopt;
  if (taken_count_ == taken_.size()) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !ready_.empty(); });
    taken_ = std::move(ready_.front());
    ready_.pop_front();
    taken_count_ = 0;
    changed_.notify_all();
    is_ended_ = taken_.empty();
    if (is_ended_) return std::nullopt;
  }
  return std::move(taken_[taken_count_++]);
}

}  // namespace slammot
