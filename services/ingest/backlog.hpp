#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "services/ingest/log_source.hpp"

namespace slammot::ingest {

/// Back-pressure at a given speed: scans that are due wait here while the services are busy with
/// earlier ones, and the oldest are dropped. A scan is done when tracking answers with its labels,
/// or, while no labels come, when localization answers: a stopped tracking does not stop
/// localization. Where nobody answers, nothing waits for long: what is sent is kept on the bus for
/// services that are being restarted. Time is a parameter.
class Backlog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  enum class Answer { kLocalized, kLabelled };

  struct Limits {
    std::size_t most_in_flight = 4;
    /// While the services answer: a scan is then dropped.
    std::chrono::nanoseconds longest_wait{150'000'000};
    /// Without labels, the answers of localization count.
    std::chrono::nanoseconds label_silence{150'000'000};
    /// Without any answer, nothing waits. Less than this and the services were held up, and have
    /// `longest_wait` from the next answer on.
    std::chrono::nanoseconds absence{500'000'000};
  };
  explicit Backlog(const Limits& limits) : limits_(limits) {}

  bool empty() const { return waiting_.empty(); }

  void add(Step step, Time now) { waiting_.push_back({std::move(step), now}); }

  /// Drops what has waited too long. Returns the number of scans among it.
  std::size_t drop_late() {
    std::size_t scans = 0;
    while (!empty() && is_late(waiting_.front())) {
      scans += waiting_.front().step.scan ? 1 : 0;
      waiting_.pop_front();
    }
    return scans;
  }

  bool may_send(Time now) const {
    const bool are_absent = !last_answer_ || now - *last_answer_ > limits_.absence;
    return !empty() && (are_absent || in_flight(now) < limits_.most_in_flight);
  }

  /// The oldest step, to be sent now. Precondition: may_send().
  Step take() {
    Step step = std::move(waiting_.front().step);
    waiting_.pop_front();
    if (step.scan) sent_ns_.push_back(step.scan->stamp_ns);
    if (sent_ns_.size() > kMostRemembered) sent_ns_.pop_front();
    return step;
  }

  /// An answer to the scan of this stamp, and so to all before it.
  void answered(Answer answer, std::int64_t stamp_ns, Time now) {
    if (!last_answer_ || now - *last_answer_ > limits_.longest_wait) resumed_ = now;
    last_answer_ = now;
    if (answer == Answer::kLocalized) {
      localized_ns_ = std::max(stamp_ns, localized_ns_.value_or(stamp_ns));
      return;
    }
    last_labels_ = now;
    while (!sent_ns_.empty() && sent_ns_.front() <= stamp_ns) sent_ns_.pop_front();
  }

 private:
  struct Waiting {
    Step step;
    Time since;
  };
  static constexpr std::size_t kMostRemembered = 100;

  /// Time in which the services did not answer does not count.
  bool is_late(const Waiting& waiting) const {
    return last_answer_ && *last_answer_ - std::max(waiting.since, resumed_) > limits_.longest_wait;
  }

  std::size_t in_flight(Time now) const {
    const bool has_labels = last_labels_ && now - *last_labels_ <= limits_.label_silence;
    if (has_labels || !localized_ns_) return sent_ns_.size();
    return static_cast<std::size_t>(std::ranges::count_if(
        sent_ns_, [this](std::int64_t stamp) { return stamp > *localized_ns_; }));
  }

  Limits limits_;
  std::deque<Waiting> waiting_;
  std::deque<std::int64_t> sent_ns_;  ///< Stamps of the last scans sent without labels.
  std::optional<std::int64_t> localized_ns_;
  std::optional<Time> last_answer_, last_labels_;
  Time resumed_{};  ///< First answer after a silence.
};

}  // namespace slammot::ingest
