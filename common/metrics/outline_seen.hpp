#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "common/metrics/scene.hpp"

namespace slammot::metrics {

/// How much of the outlines of objects had an echo so far in a drive. The outline is that of the
/// true box, in pieces of about half a metre.
class OutlinesSeen {
 public:
  /// Adds an echo of the object: the piece nearest to it is seen. Of an object without a size
  /// nothing is.
  void add(const TrueObject& object, const geometry::Vector2& point_in_world_m);

  /// Share of the pieces that are seen, in [0, 1].
  double share_of(const TrueObject& object) const;

 private:
  std::map<std::size_t, std::vector<bool>> pieces_;  ///< By TrueObject::object.
};

}  // namespace slammot::metrics
