#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "common/flow/scan_labels.hpp"
#include "common/flow/tracked_objects.hpp"

namespace slammot::localization {

/// What tracking said about scans that are not localized yet. After a restart the bus gives back
/// what was said since the checkpoint, and the scans are localized again: with it, the map of that
/// time becomes the same.
class EarlyAnswers {
 public:
  void add(flow::ScanLabels labels) { keep(labels_, std::move(labels)); }
  void add(flow::TrackedObjects objects) { keep(objects_, std::move(objects)); }

  /// True if labels of this stamp or later ones have come.
  bool reach(std::int64_t stamp_ns) const {
    return !labels_.empty() && labels_.back().stamp_ns >= stamp_ns;
  }

  /// The first ones of that scan, which are forgotten.
  std::optional<flow::ScanLabels> take_labels(std::int64_t stamp_ns,
                                              const std::string& scanner_id) {
    return take(labels_, [&](const flow::ScanLabels& labels) {
      return labels.stamp_ns == stamp_ns && labels.scanner_id == scanner_id;
    });
  }
  /// The first ones of that stamp, which are forgotten.
  std::optional<flow::TrackedObjects> take_objects(std::int64_t stamp_ns) {
    return take(objects_, [stamp_ns](const flow::TrackedObjects& objects) {
      return objects.stamp_ns == stamp_ns;
    });
  }

 private:
  static constexpr std::size_t kMost = 200;

  template <typename Answer>
  static void keep(std::deque<Answer>& answers, Answer answer) {
    answers.push_back(std::move(answer));
    if (answers.size() > kMost) answers.pop_front();
  }
  template <typename Answer, typename IsIt>
  static std::optional<Answer> take(std::deque<Answer>& answers, IsIt is_it) {
    const auto found = std::ranges::find_if(answers, is_it);
    if (found == answers.end()) return std::nullopt;
    std::optional<Answer> answer(std::move(*found));
    answers.erase(answers.begin(), std::next(found));
    return answer;
  }

  std::deque<flow::ScanLabels> labels_;
  std::deque<flow::TrackedObjects> objects_;
};

}  // namespace slammot::localization
