#include "services/localization/ambiguous_match.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace slammot::localization {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kAlongSigma_m = 1.0;   // What the spread of guesses adds to that of the prediction
                                        // along that direction.
constexpr double kAcrossSigma_m = 0.2;  // What the spread of guesses adds to that of the prediction
                                        // across that direction.
constexpr double kHeadingSigma_rad = 0.05;  // What it adds in heading.
constexpr double kLeastNarrowing = 0.7;     // Where sampling narrows the variance of the guesses by
                                            // less than this share nothing is observed.

struct WeakDirection {
  double information_per_m2 = 0.0;
  double information_across_per_m2 = 0.0;
  Vector2 unit;
};

/// Of the position, the heading being whatever fits best.
WeakDirection weakest_direction(const Matrix3& scan_information) {
  const double of_heading = scan_information(2, 2);
  Matrix2 of_position = scan_information.topLeftCorner<2, 2>();
  if (of_heading > 0.0)
    of_position -= scan_information.topRightCorner<2, 1>() *
                   scan_information.bottomLeftCorner<1, 2>() / of_heading;
  Eigen::SelfAdjointEigenSolver<Matrix2> directions;
  directions.computeDirect(of_position);
  return {directions.eigenvalues()(0), directions.eigenvalues()(1),
          directions.eigenvectors().col(0)};
}

/// What a registration says of the pose without the guesses that it came from: an offset from their
/// mean with its information, zero where it says nothing.
struct Observation {
  Matrix3 information = Matrix3::Zero();
  Eigen::Vector3d weighted_offset = Eigen::Vector3d::Zero();  ///< information * offset
};

/// At most what the closed form says: few samples may agree by chance.
Observation observed(const UncertainPose2& sampled, const UncertainPose2& guesses,
                     const Matrix3& closed_form_information, double least_narrowing) {
  // In the axes in which the guesses are round: a variance of 1 has not been narrowed.
  const Matrix3 root = guesses.covariance.llt().matrixL();
  const Matrix3 to_round = root.triangularView<Eigen::Lower>().solve(Matrix3::Identity());
  const Matrix3 most = root.transpose() * closed_form_information * root;
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(to_round * sampled.covariance *
                                                    to_round.transpose());
  const Eigen::Vector3d offset = to_round * geometry::difference(sampled.pose, guesses.pose);
  Observation observation;
  for (int i = 0; i < 3; ++i) {
    const double variance = axes.eigenvalues()(i);
    if (variance > 1.0 - least_narrowing) continue;
    const Eigen::Vector3d axis = axes.eigenvectors().col(i);
    const double information = std::min(1.0 / variance - 1.0, axis.dot(most * axis));
    const Eigen::Vector3d in_map = to_round.transpose() * axis;
    observation.information += information * in_map * in_map.transpose();
    observation.weighted_offset += information * axis.dot(offset) / (1.0 - variance) * in_map;
  }
  return observation;
}

/// The part across a direction. Few samples have the axes of what they observe a little askew, and
/// where one is known a thousand times better than the other its small part along the other looks
/// like knowledge: that one is judged by itself.
Observation across(const Vector2& direction, const Observation& observation) {
  Matrix3 projection = Matrix3::Identity();
  projection.topLeftCorner<2, 2>() -= direction * direction.transpose();
  return {projection * observation.information * projection,
          projection * observation.weighted_offset};
}

/// What the registration says along the weak direction, the rest being as it is.
Observation observed_along(const WeakDirection& weak, const UncertainPose2& sampled,
                           const UncertainPose2& guesses, double least_narrowing) {
  const auto variance_along = [&](const UncertainPose2& pose) {
    return weak.unit.dot(pose.covariance.topLeftCorner<2, 2>() * weak.unit);
  };
  const double guessed_m2 = variance_along(guesses);
  const double sampled_m2 = variance_along(sampled);
  Observation observation;
  if (sampled_m2 > (1.0 - least_narrowing) * guessed_m2) return observation;
  const double information = std::min(1.0 / sampled_m2 - 1.0 / guessed_m2, weak.information_per_m2);
  const Eigen::Vector3d axis(weak.unit.x(), weak.unit.y(), 0.0);
  observation.information = information * axis * axis.transpose();
  observation.weighted_offset = information *
                                axis.dot(geometry::difference(sampled.pose, guesses.pose)) /
                                (1.0 - sampled_m2 / guessed_m2) * axis;
  return observation;
}

UncertainPose2 fused(const UncertainPose2& prior, const Observation& observation,
                     const Pose2& about) {
  const Matrix3 prior_information = prior.covariance.inverse();
  const Matrix3 covariance = (prior_information + observation.information).inverse();
  const Eigen::Vector3d change =
      covariance *
      (observation.weighted_offset + prior_information * geometry::difference(prior.pose, about));
  return {{about.x_m + change.x(), about.y_m + change.y(),
           geometry::wrap_angle(about.heading_rad + change.z())},
          covariance};
}

double squared_distance(const UncertainPose2& prior, const Pose2& pose) {
  const Eigen::Vector3d away = geometry::difference(pose, prior.pose);
  return away.dot(prior.covariance.ldlt().solve(away));
}

const matching::PoseCluster& nearest_cluster(const std::vector<matching::PoseCluster>& clusters,
                                             const UncertainPose2& prior) {
  return *std::ranges::min_element(clusters, {}, [&](const matching::PoseCluster& cluster) {
    return squared_distance(prior, cluster.map_from_base.pose);
  });
}

}  // namespace

bool says_little(const Matrix3& scan_information, const AmbiguousMatchConfig& config) {
  const WeakDirection weak = weakest_direction(scan_information);
  return config.weak_share > 0.0 &&
         weak.information_per_m2 <= config.weak_share * weak.information_across_per_m2;
}

UncertainPose2 AmbiguousMatcher::match(const MatchToSample& match,
                                       const AmbiguousMatchConfig& config,
                                       const matching::PointToLineConfig& match_config,
                                       std::uint64_t seed) {
  const UncertainPose2& prior = match.prior_odom_from_base;
  const WeakDirection weak = weakest_direction(match.closed_form.scan_information);
  UncertainPose2 guesses{match.closed_form.map_from_base.pose, prior.covariance};
  const Matrix2 on_it = weak.unit * weak.unit.transpose();
  guesses.covariance.topLeftCorner<2, 2>() +=
      kAlongSigma_m * kAlongSigma_m * on_it +
      kAcrossSigma_m * kAcrossSigma_m * (Matrix2::Identity() - on_it);
  guesses.covariance(2, 2) += kHeadingSigma_rad * kHeadingSigma_rad;
  std::mt19937_64 random(seed);
  const matching::ScrimResult sampled =
      scrim_.match(match.points, match.surfels, guesses, config.scrim, match_config, random);
  const auto fused_with = [&](const UncertainPose2& registered) {
    Observation seen =
        across(weak.unit,
               observed(registered, guesses, match.closed_form.scan_information, kLeastNarrowing));
    const Observation along = observed_along(weak, registered, guesses, kLeastNarrowing);
    seen.information += along.information;
    seen.weighted_offset += along.weighted_offset;
    return fused(prior, seen, guesses.pose);
  };
  UncertainPose2 result = fused_with(sampled.map_from_base);
  if (sampled.clusters.size() > 1)
    result.pose = fused_with(nearest_cluster(sampled.clusters, prior).map_from_base).pose;
  return result;
}

}  // namespace slammot::localization
