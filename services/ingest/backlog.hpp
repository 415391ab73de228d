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
    /// From sending to the answer. After a slower answer one scan is in flight at a time, and after
    /// each quicker one another: latency is that of the services, not of a queue in them.
    std::chrono::nanoseconds quick_answer{100'000'000};
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
    return !empty() && (are_absent || in_flight(now) < window_);
  }

  /// The oldest step, to be sent now. Precondition: may_send().
  Step take(Time now) {
    Step step = std::move(waiting_.front().step);
    waiting_.pop_front();
    if (step.scan) sent_.push_back({step.scan->stamp_ns, now});
    if (sent_.size() > kMostRemembered) sent_.pop_front();
    return step;
  }

  /// An answer to the scan of this stamp, and so to all before it.
  void answered(Answer answer, std::int64_t stamp_ns, Time now) {
    if (!last_answer_ || now - *last_answer_ > limits_.longest_wait) resumed_ = now;
    last_answer_ = now;
    if (answer == Answer::kLabelled) last_labels_ = now;
    if (answer == Answer::kLabelled || !has_labels(now)) adapt_window(stamp_ns, now);
    if (answer == Answer::kLocalized)
      localized_ns_ = std::max(stamp_ns, localized_ns_.value_or(stamp_ns));
    else
      while (!sent_.empty() && sent_.front().stamp_ns <= stamp_ns) sent_.pop_front();
  }

 private:
  struct Waiting {
    Step step;
    Time since;
  };
  struct Sent {
    std::int64_t stamp_ns;
    Time at;
  };
  static constexpr std::size_t kMostRemembered = 100;

  /// Time in which the services did not answer does not count.
  bool is_late(const Waiting& waiting) const {
    return last_answer_ && *last_answer_ - std::max(waiting.since, resumed_) > limits_.longest_wait;
  }

  bool has_labels(Time now) const {
    return last_labels_ && now - *last_labels_ <= limits_.label_silence;
  }

  void adapt_window(std::int64_t stamp_ns, Time now) {
    const auto sent = std::ranges::find(sent_, stamp_ns, &Sent::stamp_ns);
    if (sent == sent_.end()) return;
    const bool is_quick = now - sent->at <= limits_.quick_answer;
    window_ = is_quick ? std::min(window_ + 1, limits_.most_in_flight) : 1;
  }

  std::size_t in_flight(Time now) const {
    if (has_labels(now) || !localized_ns_) return sent_.size();
    return static_cast<std::size_t>(std::ranges::count_if(
        sent_, [this](const Sent& sent) { return sent.stamp_ns > *localized_ns_; }));
  }

  Limits limits_;
  std::deque<Waiting> waiting_;
  std::deque<Sent> sent_;  ///< The last scans sent without labels.
  std::size_t window_ = limits_.most_in_flight;
  std::optional<std::int64_t> localized_ns_;
  std::optional<Time> last_answer_, last_labels_;
  Time resumed_{};  ///< First answer after a silence.
};

}  // namespace slammot::ingest
