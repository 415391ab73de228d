#include "services/localization/submap_saliency.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/matching/saliency.hpp"

namespace slammot::localization {

double saliency_of(const flow::Submap& submap) {
  constexpr double kSurfelSigmaM = 0.03;
  constexpr double kSurfelSizeM = 0.4;
  constexpr std::size_t kMostPoints = 200;
  matching::SaliencyConfig config;
  config.surfel_size_m = kSurfelSizeM;
  config.most_points = kMostPoints;
  config.scrim.samples = 16;
  config.scrim.cell_size_m = kSurfelSizeM;
  std::vector<matching::MatchPoint> points;
  points.reserve(submap.surfels.size());
  double farthest_m = 1.0;
  for (const flow::Surfel& surfel : submap.surfels) {
    points.push_back({{surfel.x_m, surfel.y_m}, kSurfelSigmaM});
    farthest_m = std::max(farthest_m, points.back().in_base_m.norm());
  }
  config.heading_sigma_rad =
      std::min(config.heading_sigma_rad, config.position_sigma_m / farthest_m);
  std::mt19937_64 random(submap.submap_id.value);
  return matching::saliency_score(points, config, random);
}

}  // namespace slammot::localization
