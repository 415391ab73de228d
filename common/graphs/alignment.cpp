#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/graphs/absolute_priors.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Pose2;
using geometry::Vector2;

constexpr std::size_t kFewest = 10;      // measurements of a kind
constexpr double kLeastExtent_m = 20.0;  // of the positions: less does not determine a direction
constexpr double kOutlierSigmas = 3.0;
constexpr double kMedianOfChi2 = 1.3863;  // 2 degrees of freedom
constexpr double kMedianOfChi1 = 0.4549;  // 1 degree of freedom
constexpr double kCommonError_m = 1.0;    // of all fixes of a drive: ionosphere, orbits
constexpr double kBiasSigma_rad = 0.05;   // of a compass that nothing calibrates

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// A position with its point in map.
struct Pair {
  Vector2 in_map_m;
  Vector2 in_enu_m;
  Matrix2 information;
};

std::map<flow::SubmapId, Pose2> by_id(const std::vector<flow::CorrectedSubmap>& nodes) {
  std::map<flow::SubmapId, Pose2> poses;
  for (const flow::CorrectedSubmap& node : nodes)
    poses.emplace(node.submap_id, node.map_from_submap);
  return poses;
}

std::vector<Pair> pairs_of(const std::map<flow::SubmapId, Pose2>& nodes,
                           const std::vector<PositionPrior>& priors) {
  std::vector<Pair> pairs;
  for (const PositionPrior& prior : priors)
    pairs.push_back(
        {nodes.at(prior.node) * prior.in_node_m, prior.in_enu_m, prior.covariance_m2.inverse()});
  return pairs;
}

std::vector<double> squared_errors(const std::vector<Pair>& pairs, const Pose2& enu_from_map) {
  std::vector<double> errors;
  errors.reserve(pairs.size());
  for (const Pair& pair : pairs) {
    const Vector2 error_m = enu_from_map * pair.in_map_m - pair.in_enu_m;
    errors.push_back(error_m.dot(pair.information * error_m));
  }
  return errors;
}

double extent_m(const std::vector<Pair>& pairs) {
  Vector2 low = pairs.front().in_map_m;
  Vector2 high = low;
  for (const Pair& pair : pairs) {
    low = low.cwiseMin(pair.in_map_m);
    high = high.cwiseMax(pair.in_map_m);
  }
  return (high - low).norm();
}

/// The pose that two positions give.
Pose2 pose_of(const Pair& a, const Pair& b) {
  const Vector2 in_map_m = b.in_map_m - a.in_map_m;
  const Vector2 in_enu_m = b.in_enu_m - a.in_enu_m;
  const double turn_rad = geometry::wrap_angle(std::atan2(in_enu_m.y(), in_enu_m.x()) -
                                               std::atan2(in_map_m.y(), in_map_m.x()));
  const Vector2 middle_m = 0.5 * (a.in_enu_m + b.in_enu_m) -
                           geometry::rotation(turn_rad) * (0.5 * (a.in_map_m + b.in_map_m));
  return {middle_m.x(), middle_m.y(), turn_rad};
}

/// Pose of the least median of squared errors over pairs that lie far apart.
Pose2 least_median_pose(const std::vector<Pair>& pairs, double extent) {
  constexpr int kSamples = 300;
  constexpr double kFarShare = 0.3;
  std::uint64_t state = 1;  // the generator of Knuth's MMIX
  const auto draw = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(state >> 33) % pairs.size();
  };
  Pose2 best;
  double least = std::numeric_limits<double>::infinity();
  for (int sample = 0; sample < kSamples; ++sample) {
    const Pair& a = pairs[draw()];
    const Pair& b = pairs[draw()];
    if ((a.in_map_m - b.in_map_m).norm() < kFarShare * extent) continue;
    const Pose2 pose = pose_of(a, b);
    const double median = median_of(squared_errors(pairs, pose));
    if (median >= least) continue;
    least = median;
    best = pose;
  }
  return best;
}

/// Least squares over the inliers in closed form, all with the weight of their mean variance
/// (Umeyama 1991).
Pose2 least_squares_pose(const std::vector<Pair>& pairs, const std::vector<bool>& is_inlier) {
  double sum = 0.0;
  Vector2 mean_map_m = Vector2::Zero();
  Vector2 mean_enu_m = Vector2::Zero();
  const auto weight_of = [](const Pair& pair) { return 0.5 * pair.information.trace(); };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_inlier[i]) continue;
    const double weight = weight_of(pairs[i]);
    sum += weight;
    mean_map_m += weight * pairs[i].in_map_m;
    mean_enu_m += weight * pairs[i].in_enu_m;
  }
  mean_map_m /= sum;
  mean_enu_m /= sum;
  double along = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!is_inlier[i]) continue;
    const Vector2 a = pairs[i].in_map_m - mean_map_m;
    const Vector2 b = pairs[i].in_enu_m - mean_enu_m;
    along += weight_of(pairs[i]) * a.dot(b);
    across += weight_of(pairs[i]) * (a.x() * b.y() - a.y() * b.x());
  }
  const double turn_rad = std::atan2(across, along);
  const Vector2 shift_m = mean_enu_m - geometry::rotation(turn_rad) * mean_map_m;
  return {shift_m.x(), shift_m.y(), turn_rad};
}

/// Outliers and scale of squared normalized errors, whose median is known if the claimed sigmas are
/// true.
PriorAgreement agreement_of(const std::vector<double>& squared, double true_median) {
  PriorAgreement agreement;
  agreement.scale = std::max(1.0, std::sqrt(median_of(squared) / true_median));
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

/// Covariance of the alignment: origin's position per axis and direction.
void set_uncertainty(const std::vector<Pair>& pairs, AbsoluteFit& fit) {
  geometry::Matrix3 information = geometry::Matrix3::Zero();
  const double factor =
      1.0 / (fit.positions.correlated * fit.positions.scale * fit.positions.scale);
  const Matrix2 turn = geometry::rotation(fit.enu_from_map.heading_rad);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!fit.positions.is_inlier[i]) continue;
    const Vector2 arm_m = turn * pairs[i].in_map_m;
    Eigen::Matrix<double, 2, 3> jacobian;
    jacobian << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
    information += factor * jacobian.transpose() * pairs[i].information * jacobian;
  }
  const geometry::Matrix3 covariance = information.inverse();
  const double direction_by_common_rad = kCommonError_m / extent_m(pairs);
  fit.position_sigma_m =
      std::hypot(std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1))), kCommonError_m);
  fit.direction_sigma_rad = std::hypot(std::sqrt(covariance(2, 2)), direction_by_common_rad);
}

void align_positions(const std::vector<Pair>& pairs, AbsoluteFit& fit) {
  fit.positions.is_inlier.assign(pairs.size(), false);
  if (pairs.size() < kFewest) return;
  const double extent = extent_m(pairs);
  if (extent < kLeastExtent_m) return;
  fit.enu_from_map = least_median_pose(pairs, extent);
  for (int iteration = 0; iteration < 10; ++iteration) {
    fit.positions = agreement_of(squared_errors(pairs, fit.enu_from_map), kMedianOfChi2);
    fit.enu_from_map = least_squares_pose(pairs, fit.positions.is_inlier);
  }
  std::vector<Vector2> errors_m;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (fit.positions.is_inlier[i])
      errors_m.emplace_back(fit.enu_from_map * pairs[i].in_map_m - pairs[i].in_enu_m);
  }
  fit.positions.correlated = correlated(errors_m);
  fit.has_position = fit.has_direction = true;
  set_uncertainty(pairs, fit);
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
    const double median = median_of(squared_errors(directions_rad, directions_rad[i], priors));
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
  align_positions(pairs_of(poses, priors.positions), fit);
  align_headings(poses, priors.headings, fit);
  return fit;
}

}  // namespace slammot::graphs
