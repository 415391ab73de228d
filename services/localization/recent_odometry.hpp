#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <iterator>
#include <vector>

#include "common/sensing/scan.hpp"

namespace slammot::localization {

/// The last odometry in the order of arrival: that of a new drive may come before its first scan.
class RecentOdometry {
 public:
  void add(const sensing::Odometry& odometry) {
    recent_.push_back(odometry);
    if (recent_.size() > kKept) recent_.pop_front();
  }

  /// What came since stamps last went back.
  std::vector<sensing::Odometry> of_newest_drive() const {
    const auto goes_back = [](const sensing::Odometry& after, const sensing::Odometry& before) {
      return after.stamp_ns < before.stamp_ns;
    };
    const auto earliest = std::adjacent_find(recent_.rbegin(), recent_.rend(), goes_back);
    const auto first = earliest == recent_.rend() ? recent_.begin() : std::prev(earliest.base());
    return {first, recent_.end()};
  }

 private:
  static constexpr std::size_t kKept = 300;

  std::deque<sensing::Odometry> recent_;
};

}  // namespace slammot::localization
