#pragma once

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "common/flow/scan_labels.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/memory/spares.hpp"
#include "common/work/side_work.hpp"
#include "services/tracking/associations.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Memory that the tracker reuses from scan to scan, and a helper thread if there is one. Neither
/// changes a result: a tracker allocates nothing while no more is in view than ever was. Known to
/// Tracker only.
class Workspace {
 public:
  /// help (null: none) must outlive this.
  explicit Workspace(work::SideWork* help) : help_(help) {}

  /// Calls part(i) for each i < count, perhaps side by side: each must write what no other reads or
  /// writes.
  template <typename Part>
  void for_each(std::size_t count, const Part& part) const {
    work::share(help_, count, part);
  }

  /// The same in a few ranges, for small parts.
  template <typename Part>
  void for_each_in_ranges(std::size_t count, const Part& part) const {
    constexpr std::size_t kRanges = 4;  // parts differ in size
    work::share_in_ranges(help_, count, kRanges, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) part(i);
    });
  }

  /// Resizes with elements that keep their memory; new elements hold what they held when they were
  /// removed.
  template <typename T>
  void resize(std::vector<T>& things, std::size_t count) {
    std::get<memory::Spares<T>>(spares_).resize(things, count);
  }

  /// Removes the elements of which `is_over` is true, keeps the order of the others, and keeps the
  /// memory of the removed.
  template <typename T, typename Predicate>
  void remove_if(std::vector<T>& things, const Predicate& is_over) {
    std::size_t kept = 0;
    for (T& thing : things) {
      if (is_over(thing)) {
        std::get<memory::Spares<T>>(spares_).give(std::move(thing));
        continue;
      }
      if (&thing != &things[kept]) things[kept] = std::move(thing);
      ++kept;
    }
    things.erase(things.begin() + static_cast<std::ptrdiff_t>(kept), things.end());
  }

 private:
  work::SideWork* help_;
  std::tuple<memory::Spares<Track>, memory::Spares<TrackShare>, memory::Spares<flow::TrackedObject>,
             memory::Spares<flow::RestoredPoints>>
      spares_;
};

}  // namespace slammot::tracking
