#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/city_model/profile_model.hpp"
#include "common/metrics/statistics.hpp"

namespace slammot::city_model {

/// A true upright surface from the road to its height, in the world's frame.
struct TrueSurface {
  geometry::Vector2 from_m = geometry::Vector2::Zero();
  geometry::Vector2 to_m = geometry::Vector2::Zero();
  double height_m = 0.0;
  bool is_wall = false;  ///< Of a building.
};

struct ModelTruth {
  geometry::Pose2 world_from_map;
  std::vector<TrueSurface> surfaces;
  std::vector<std::uint8_t> is_of_mover;  ///< One a point of the model; empty if unknown.
};

struct ModelAccuracy {
  metrics::ErrorSummary point_distance_m;  ///< To the nearest surface, in the plan.
  double astray_share = 0.0;               ///< Of the points: farther than kAstray_m.
  metrics::ErrorSummary wall_top_error_m;  ///< Of facades on a wall, absolute.
  double wall_top_bias_m = 0.0;            ///< Median of estimate less truth.
  double residue_share = 0.0;              ///< Of the points: echoes of movers.
};

inline constexpr double kAstray_m = 1.0;

/// Points farther than kAstray_m from all surfaces count as that far.
ModelAccuracy judge(const CityModel& model, const ModelTruth& truth);

}  // namespace slammot::city_model
