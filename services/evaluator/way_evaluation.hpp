#pragma once

#include <array>
#include <vector>

#include "common/metrics/scene.hpp"
#include "common/traffic/way_accuracy.hpp"

namespace slammot::evaluator {

/// Lanes, cycle lanes and walkways against the ways of true movers, by kind.
struct WayEvaluation {
  double least_confidence = 0.6;  ///< That only two tracks or more can give.
  std::array<traffic::WayAccuracy, traffic::kMovers> all;
  std::array<traffic::WayAccuracy, traffic::kMovers> confident;  ///< Only ways that reach it.
};

/// Steps of the true objects, in map. In view is an object that counts in the scene where the step
/// ends.
std::vector<traffic::TrueStep> true_steps(const std::vector<metrics::Scene>& scenes,
                                          const geometry::Pose2& map_from_world,
                                          const metrics::CountingRule& rule);

WayEvaluation evaluate_ways(const std::vector<traffic::Way>& ways,
                            const std::vector<traffic::TrueStep>& steps);

/// Name of a kind in figures.
const char* name_of(traffic::Mover mover);

}  // namespace slammot::evaluator
