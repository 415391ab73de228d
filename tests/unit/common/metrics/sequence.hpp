#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/metrics/matching.hpp"

namespace slammot::metrics {

/// A scan in which objects and tracks are places on a line; similarity is 1 - distance, at least 0.
inline MotFrame scan(const std::vector<std::pair<std::size_t, double>>& objects,
                     const std::vector<std::pair<std::size_t, double>>& tracks) {
  MotFrame frame;
  frame.similarity.resize(static_cast<Eigen::Index>(objects.size()),
                          static_cast<Eigen::Index>(tracks.size()));
  for (const auto& [id, place] : objects) frame.objects.push_back(id);
  for (const auto& [id, place] : tracks) frame.tracks.push_back(id);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    for (std::size_t j = 0; j < tracks.size(); ++j) {
      frame.similarity(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
          std::max(0.0, 1.0 - std::abs(objects[i].second - tracks[j].second));
    }
  }
  return frame;
}

}  // namespace slammot::metrics
