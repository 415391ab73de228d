#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/flow/ids.hpp"
#include "common/matching/wide_search.hpp"
#include "services/loop_closing/place.hpp"

namespace slammot::loop_closing {

/// Cache of the score pyramids of the targets used last.
class PyramidCache {
 public:
  struct Pyramid {
    std::shared_ptr<const matching::ScorePyramid> pyramid;
    std::uint64_t work = 0;  ///< Cells written by this call.
  };
  Pyramid pyramid_of(const Target& target, double cell_m);

 private:
  struct Entry {
    std::vector<std::pair<flow::SubmapId, geometry::Pose2>> members = {};
    std::shared_ptr<const matching::ScorePyramid> pyramid = nullptr;
    std::uint64_t used = 0;
  };
  static bool is_of(const Entry& entry, const Target& target, double cell_m);

  std::vector<Entry> entries_;
  std::uint64_t uses_ = 0;
};

}  // namespace slammot::loop_closing
