#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <Eigen/Cholesky>

#include "common/geometry/order_statistics.hpp"
#include "common/graphs/absolute_priors.hpp"
#include "common/graphs/place_of_map.hpp"

namespace slammot::graphs {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr std::size_t kFewest = 10;      // measurements of a kind
constexpr double kLeastExtent_m = 20.0;  // of the positions: less does not determine a direction
constexpr double kOutlierSigmas = 3.0;
constexpr double kMedianOfChi2 = 1.3863;  // 2 degrees of freedom
constexpr double kMedianOfChi1 = 0.4549;  // 1 degree of freedom
constexpr double kCommonError_m = 1.0;    // of all fixes of a drive: ionosphere, orbits
constexpr double kBiasSigma_rad = 0.05;   // of a compass that nothing calibrates

std::map<flow::SubmapId, Pose2> by_id(const std::vector<flow::CorrectedSubmap>& nodes) {
  std::map<flow::SubmapId, Pose2> poses;
  for (const flow::CorrectedSubmap& node : nodes)
    poses.emplace(node.submap_id, node.map_from_submap);
  return poses;
}

std::vector<Fix> fixes_of(const std::map<flow::SubmapId, Pose2>& nodes,
                          const std::vector<PositionPrior>& priors) {
  std::vector<Fix> fixes;
  for (const PositionPrior& prior : priors) {
    const Vector2 in_map_m = nodes.at(prior.node) * prior.in_node_m;
    const double way_m = fixes.empty() ? 0.0 : (in_map_m - fixes.back().in_map_m).norm();
    fixes.push_back({in_map_m, prior.in_enu_m, prior.covariance_m2, way_m});
  }
  return fixes;
}

/// Outliers and scale of squared normalized errors, whose median is known if the claimed sigmas are
/// true.
PriorAgreement agreement_of(const std::vector<double>& squared, double true_median) {
  PriorAgreement agreement;
  agreement.scale = std::max(1.0, std::sqrt(geometry::upper_median(squared) / true_median));
  const double limit = kOutlierSigmas * kOutlierSigmas * agreement.scale * agreement.scale;
  for (const double error : squared) agreement.is_inlier.push_back(error <= limit);
  return agreement;
}

/// Integrated autocorrelation of a sequence of errors: this many count as one.
double correlated(const std::vector<Vector2>& errors) {
  constexpr double kNone = 0.05;
  double variance = 0.0;
  for (const Vector2& error : errors) variance += error.squaredNorm();
  if (variance <= 0.0) return 1.0;
  variance /= static_cast<double>(errors.size());
  double sum = 1.0;
  for (std::size_t lag = 1; lag < errors.size() / 4; ++lag) {
    double covariance = 0.0;
    for (std::size_t i = lag; i < errors.size(); ++i) covariance += errors[i].dot(errors[i - lag]);
    const double correlation = covariance / static_cast<double>(errors.size() - lag) / variance;
    if (correlation < kNone) break;
    sum += 2.0 * correlation;
  }
  return sum;
}

std::vector<Vector2> errors_of(const std::vector<Fix>& fixes, const Pose2& enu_from_map) {
  std::vector<Vector2> errors_m;
  for (const Fix& fix : fixes) errors_m.push_back(enu_from_map * fix.in_map_m - fix.in_enu_m);
  return errors_m;
}

/// Outliers, scale and correlation of the errors of all fixes.
PriorAgreement agreement_of(const std::vector<Fix>& fixes, const Pose2& enu_from_map) {
  const std::vector<Vector2> errors_m = errors_of(fixes, enu_from_map);
  std::vector<double> squared;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    squared.push_back(errors_m[i].dot(fixes[i].covariance_m2.ldlt().solve(errors_m[i])));
  PriorAgreement agreement = agreement_of(squared, kMedianOfChi2);
  std::vector<Vector2> of_inliers;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    if (agreement.is_inlier[i]) of_inliers.push_back(errors_m[i]);
  agreement.correlated = correlated(of_inliers);
  return agreement;
}

void align_positions(const std::vector<Fix>& fixes, AbsoluteFit& fit) {
  fit.positions.is_inlier.assign(fixes.size(), false);
  if (fixes.size() < kFewest) return;
  const double extent = extent_of(fixes).size_m;
  if (extent < kLeastExtent_m) return;
  const std::vector<PlaceMode> modes = place_of_map(fixes);
  if (modes.empty()) return;
  fit.enu_from_map = modes.front().enu_from_map;
  fit.positions = agreement_of(fixes, fit.enu_from_map);
  fit.has_position = fit.has_direction = true;
  const geometry::Matrix3 covariance = spread_about(fit.enu_from_map, modes);
  fit.position_sigma_m =
      std::hypot(std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1))), kCommonError_m);
  fit.direction_sigma_rad = std::hypot(std::sqrt(covariance(2, 2)), kCommonError_m / extent);
}

/// Of all readings: the direction of the map's x axis that each implies, with the bias.
std::vector<double> directions_of(const std::map<flow::SubmapId, Pose2>& nodes,
                                  const std::vector<HeadingPrior>& priors) {
  std::vector<double> directions_rad;
  for (const HeadingPrior& prior : priors)
    directions_rad.push_back(geometry::wrap_angle(
        prior.in_enu_rad - nodes.at(prior.node).heading_rad - prior.in_node_rad));
  return directions_rad;
}

std::vector<double> squared_errors(const std::vector<double>& directions_rad, double centre_rad,
                                   const std::vector<HeadingPrior>& priors) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < directions_rad.size(); ++i) {
    const double error = geometry::wrap_angle(directions_rad[i] - centre_rad) / priors[i].sigma_rad;
    errors.push_back(error * error);
  }
  return errors;
}

/// The direction of the least median of squared errors.
double least_median_direction(const std::vector<double>& directions_rad,
                              const std::vector<HeadingPrior>& priors) {
  constexpr std::size_t kSamples = 200;
  const std::size_t stride = std::max<std::size_t>(1, directions_rad.size() / kSamples);
  double best_rad = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < directions_rad.size(); i += stride) {
    const double median =
        geometry::upper_median(squared_errors(directions_rad, directions_rad[i], priors));
    if (median >= least) continue;
    least = median;
    best_rad = directions_rad[i];
  }
  return best_rad;
}

double mean_of_inliers(const std::vector<double>& directions_rad, double about_rad,
                       const std::vector<bool>& is_inlier) {
  double sum_rad = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < directions_rad.size(); ++i) {
    if (!is_inlier[i]) continue;
    sum_rad += geometry::wrap_angle(directions_rad[i] - about_rad);
    count += 1.0;
  }
  return geometry::wrap_angle(about_rad + sum_rad / count);
}

/// Direction and bias from what the compass says of their sum.
void combine(double sum_rad, double sum_sigma_rad, AbsoluteFit& fit) {
  const double compass_variance = sum_sigma_rad * sum_sigma_rad + kBiasSigma_rad * kBiasSigma_rad;
  if (!fit.has_direction) {
    fit.enu_from_map.heading_rad = sum_rad;
    fit.direction_sigma_rad = std::sqrt(compass_variance);
    fit.has_direction = true;
    return;
  }
  fit.heading_bias_rad = geometry::wrap_angle(sum_rad - fit.enu_from_map.heading_rad);
}

void align_headings(const std::map<flow::SubmapId, Pose2>& nodes,
                    const std::vector<HeadingPrior>& priors, AbsoluteFit& fit) {
  fit.headings.is_inlier.assign(priors.size(), false);
  if (priors.size() < kFewest) return;
  const std::vector<double> directions_rad = directions_of(nodes, priors);
  double centre_rad = least_median_direction(directions_rad, priors);
  for (int iteration = 0; iteration < 10; ++iteration) {
    fit.headings = agreement_of(squared_errors(directions_rad, centre_rad, priors), kMedianOfChi1);
    centre_rad = mean_of_inliers(directions_rad, centre_rad, fit.headings.is_inlier);
  }
  std::vector<Vector2> errors;
  for (std::size_t i = 0; i < priors.size(); ++i) {
    if (fit.headings.is_inlier[i])
      errors.emplace_back(geometry::wrap_angle(directions_rad[i] - centre_rad), 0.0);
  }
  fit.headings.correlated = correlated(errors);
  const double independent = static_cast<double>(errors.size()) / fit.headings.correlated;
  combine(centre_rad,
          fit.headings.scale * priors.front().sigma_rad / std::sqrt(std::max(1.0, independent)),
          fit);
}

}  // namespace

std::size_t PriorAgreement::inliers() const {
  return static_cast<std::size_t>(std::ranges::count(is_inlier, true));
}

AbsoluteFit align(const std::vector<flow::CorrectedSubmap>& nodes, const AbsolutePriors& priors) {
  AbsoluteFit fit;
  const std::map<flow::SubmapId, Pose2> poses = by_id(nodes);
  align_positions(fixes_of(poses, priors.positions), fit);
  align_headings(poses, priors.headings, fit);
  return fit;
}

}  // namespace slammot::graphs
