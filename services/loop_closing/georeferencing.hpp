#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/submap.hpp"
#include "common/geometry/geodetic.hpp"
#include "common/graphs/absolute_priors.hpp"

namespace slammot::loop_closing {

/// GNSS fixes and compass readings as priors of the pose graph. They correct the poses of submaps
/// only where constraints and fixes contradict each other by more than their errors explain. Fixes
/// that fit nowhere, and a compass that GNSS contradicts, are not used.
/// Closures are accepted or rejected without them, so that no multipath error can close a loop.
class Georeferencing {
 public:
  /// Poses of the connected submaps, and what the measurements say of the map.
  struct Result {
    std::vector<flow::CorrectedSubmap> submaps;
    flow::Georeference georeference;
  };

  /// Takes the measurements of a submap.
  void add(const flow::Submap& submap);

  /// Compares the measurements with the graph. `connected`: submaps connected to the first one,
  /// ascending; `constraints`: gives the enabled ones between these, if they are needed. None
  /// without measurements.
  std::optional<Result> compare(
      const std::vector<flow::CorrectedSubmap>& connected,
      const std::function<std::vector<flow::Constraint>()>& constraints) const;

 private:
  graphs::AbsolutePriors priors_of(const std::vector<flow::CorrectedSubmap>& connected) const;
  flow::Georeference georeference_of(const graphs::AbsoluteFit& fit,
                                     const graphs::AbsolutePriors& priors) const;

  std::optional<geometry::Geodetic> enu_origin_;  ///< The first fix.
  graphs::AbsolutePriors priors_;
};

}  // namespace slammot::loop_closing
