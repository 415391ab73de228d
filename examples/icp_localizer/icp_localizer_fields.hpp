#pragma once

#include "common/config/fields.hpp"
#include "examples/icp_localizer/icp_localizer_config.hpp"

namespace slammot::icp_localizer {

/// The settings of stage `localization` that this implementation reads. A profile sets them for all
/// implementations.
inline const config::FieldTable<IcpLocalizerConfig>& icp_localizer_fields() {
  using C = IcpLocalizerConfig;
  using config::kNotNegative;
  using config::kPositive;
  using config::Range;
  static const config::FieldTable<C> table = {
      {"match_range_m", &C::match_range_m, "Echoes beyond it are not matched.", kPositive},
      {"map_range_m", &C::map_range_m, "Echoes beyond it are not mapped.", kPositive},
      {"min_range_m", &C::min_range_m, "Nearer echoes come from the vehicle itself.", kNotNegative},
      {"range_noise_m", &C::range_noise_m, "One sigma at the scanner.", kPositive},
      {"use_odometry", &C::use_odometry, "Off: constant velocity predicts."},
      {"map.side_m", &C::side_m, "Of the square held around the vehicle.", Range{10.0, 1000.0}},
      {"map.cell_size_m", &C::cell_size_m, "Of SO-map and MO-map.", Range{0.02, 1.0}},
      {"map.surfel_size_m", &C::surfel_size_m,
       "Of the cells whose echoes are averaged for matching.", Range{0.02, 2.0}},
      {"map.new_map_after_m", &C::new_map_after_m,
       "Distance from its centre at which the next local map begins.", kPositive},
      {"map.new_map_after_travel_m", &C::new_map_after_travel_m,
       "Distance travelled in a local map before the next one begins.", kPositive},
      {"map.no_echo_free_m", &C::no_echo_free_m, "Free way of a beam without echo.", kNotNegative},
      {"map.end_cell_tolerance_m", &C::end_cell_tolerance_m,
       "An occupied cell this near explains an echo.", kNotNegative},
      {"drift_m_per_sqrt_m", &C::drift_m_per_sqrt_m,
       "Random walk of matching, one sigma, for submap constraints.", kPositive},
      {"drift_rad_per_sqrt_m", &C::drift_rad_per_sqrt_m,
       "Random walk of matching, one sigma, for submap constraints.", kPositive},
  };
  return table;
}

}  // namespace slammot::icp_localizer
