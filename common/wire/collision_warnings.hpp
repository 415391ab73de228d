#pragma once

#include <string_view>
#include <vector>

#include "common/flow/collision_warnings.hpp"
#include "common/wire/decoded.hpp"
#include "idl/collision.h"

namespace slammot::wire {

/// Puts collision warnings on the wire; keeps its buffer.
class CollisionWarningsEncoder {
 public:
  /// The result is valid until the next call. Of more than kMostObjects, those with the highest
  /// level and then the highest probability are kept.
  const slammot_CollisionWarnings& encode(std::string_view vehicle_id,
                                          const flow::CollisionWarnings& warnings);

 private:
  slammot_CollisionWarnings sample_{};
  std::vector<slammot_CollisionWarning> objects_;
};

Decoded<flow::CollisionWarnings> decode(const slammot_CollisionWarnings& sample);

}  // namespace slammot::wire
