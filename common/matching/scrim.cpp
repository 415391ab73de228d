#include "common/matching/scrim.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "common/geometry/displacement.hpp"

namespace slammot::matching {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kLeastEvidence = 0.05;  // cells of the scan with less evidence are ignored
constexpr double kSigmasAround = 3.0;    // of the prior: extent of the map region in use

/// Samples with zero mean and exactly this covariance, in antithetic pairs.
std::vector<Eigen::Vector3d> paired_draws(int pairs, const Matrix3& covariance,
                                          std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> draws;
  Matrix3 scatter = Matrix3::Zero();
  for (int i = 0; i < pairs; ++i) {
    draws.emplace_back(normal(random), normal(random), normal(random));
    scatter += draws.back() * draws.back().transpose() / pairs;
  }
  const Matrix3 root = covariance.llt().matrixL();
  const Matrix3 whitened = scatter.llt().matrixL().solve(Matrix3::Identity());
  const Matrix3 to_covariance = root * whitened;
  std::vector<Eigen::Vector3d> paired;
  for (const Eigen::Vector3d& draw : draws) {
    paired.emplace_back(to_covariance * draw);
    paired.emplace_back(-paired.back());
  }
  return paired;
}

std::vector<UncertainPoint> uncertain_points(const std::vector<MatchPoint>& points) {
  std::vector<UncertainPoint> uncertain;
  uncertain.reserve(points.size());
  for (const MatchPoint& point : points)
    uncertain.push_back({point.in_base_m, point.sigma_m * point.sigma_m * Matrix2::Identity()});
  return uncertain;
}

/// Gaussians of surfels near the scan: length is the cell, thickness is the spread of the echoes.
std::vector<UncertainPoint> uncertain_points(const grids::SurfelMap& surfels,
                                             const Eigen::AlignedBox2d& near) {
  const double along_m2 = surfels.window().cell_size_m * surfels.window().cell_size_m / 12.0;
  std::vector<UncertainPoint> uncertain;
  for (const grids::SurfelView& surfel : surfels.all()) {
    if (!near.contains(surfel.mean_m)) continue;
    const Matrix2 across = surfel.normal * surfel.normal.transpose();  // zero if the surfel has no
                                                                       // direction
    uncertain.push_back(
        {surfel.mean_m, along_m2 * (Matrix2::Identity() - across) + surfel.spread_m2 * across});
  }
  return uncertain;
}

Eigen::AlignedBox2d reach_of(const std::vector<MatchPoint>& points, const UncertainPose2& prior) {
  Eigen::AlignedBox2d box;
  double farthest_m = 0.0;
  for (const MatchPoint& point : points) {
    box.extend(prior.pose * point.in_base_m);
    farthest_m = std::max(farthest_m, point.in_base_m.norm());
  }
  const Eigen::Vector3d sigmas = prior.covariance.diagonal().cwiseSqrt();
  const Vector2 margin =
      kSigmasAround * (sigmas.head<2>() + Vector2::Constant(sigmas.z() * farthest_m));
  return {Vector2(box.min() - margin), Vector2(box.max() + margin)};
}

}  // namespace

/// Weighted samples as one Gaussian.
class Scrim::Moments {
 public:
  explicit Moments(const Pose2& about) : about_(about) {}

  void add(const Sample& sample) {
    const Eigen::Vector3d away = geometry::difference(sample.map_from_base, about_);
    ++count_;
    weight_ += sample.correlation;
    sum_ += sample.correlation * away;
    squares_ += sample.correlation * (away * away.transpose() + sample.by_noise);
    by_guess_ += sample.correlation * sample.by_guess;
  }

  double weight() const { return weight_; }

  UncertainPose2 gaussian(std::size_t guesses) const {
    const Eigen::Vector3d mean = sum_ / weight_;
    const double not_shown = 1.0 / static_cast<double>(count_) - 1.0 / static_cast<double>(guesses);
    return {geometry::displaced(about_, mean),
            (squares_ + not_shown * by_guess_) / weight_ - mean * mean.transpose()};
  }

 private:
  Pose2 about_;
  std::size_t count_ = 0;
  double weight_ = 0.0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Matrix3 squares_ = Matrix3::Zero();
  Matrix3 by_guess_ = Matrix3::Zero();
};

double Scrim::correlation_at(const Pose2& map_from_base) const {
  return correlation(map_patch_, scan_cells_, map_from_base);
}

int Scrim::gather(double valley_share) {
  // Minimum spanning tree over all samples (Prim 1957); an edge across a valley starts a new
  // cluster.
  struct Reach {
    double length_m = std::numeric_limits<double>::infinity();
    std::size_t from = 0;
    bool is_joined = false;
  };
  std::vector<Reach> reach(samples_.size());
  reach.front() = {0.0, 0, false};
  int clusters = 0;
  for (std::size_t joined = 0; joined < samples_.size(); ++joined) {
    std::size_t next = samples_.size();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      if (!reach[i].is_joined &&
          (next == samples_.size() || reach[i].length_m < reach[next].length_m))
        next = i;
    }
    Sample& sample = samples_[next];
    const Sample& neighbour = samples_[reach[next].from];
    const Pose2 between = geometry::interpolate(neighbour.map_from_base, sample.map_from_base, 0.5);
    const bool is_first = joined == 0;
    const bool is_across_valley =
        !is_first && correlation_at(between) <
                         valley_share * std::min(sample.correlation, neighbour.correlation);
    sample.cluster = is_first || is_across_valley ? clusters++ : neighbour.cluster;
    reach[next].is_joined = true;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double length_m = geometry::as_seen_10_m_away(
          geometry::difference(samples_[i].map_from_base, sample.map_from_base));
      if (!reach[i].is_joined && length_m < reach[i].length_m) reach[i] = {length_m, next, false};
    }
  }
  return clusters;
}

ScrimResult Scrim::match(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                         const UncertainPose2& prior, const ScrimConfig& config,
                         const PointToLineConfig& match_config, std::mt19937_64& random) {
  assert(config.samples >= 8);
  ScrimResult result{.map_from_base = prior, .clusters = {{prior, 1.0}}};
  if (points.empty()) return result;
  scan_cells_ =
      OccupancyPatch(uncertain_points(points), config.cell_size_m).occupied(kLeastEvidence);
  map_patch_ =
      OccupancyPatch(uncertain_points(surfels, reach_of(points, prior)), config.cell_size_m);
  const Matrix3 prior_information = prior.covariance.inverse();
  samples_.clear();
  double best = 0.0;
  const std::vector<Eigen::Vector3d> draws =
      paired_draws(config.samples / 2, prior.covariance, random);
  for (const Eigen::Vector3d& draw : draws) {
    const Pose2 guess = geometry::displaced(prior.pose, draw);
    const PointToLineResult refined =
        matcher_.match(points, surfels, {guess, prior.covariance}, guess, match_config);
    result.matched_share += refined.matched_share / static_cast<double>(draws.size());
    if (refined.matched_points == 0) continue;
    const Pose2& pose = refined.map_from_base.pose;
    const Matrix3& covariance = refined.map_from_base.covariance;
    samples_.push_back({.map_from_base = pose,
                        .by_noise = covariance * refined.scan_information * covariance,
                        .by_guess = covariance * prior_information * covariance,
                        .correlation = correlation_at(pose)});
    best = std::max(best, samples_.back().correlation);
  }
  if (best <= 0.0) return result;
  std::erase_if(samples_, [&](const Sample& sample) {
    return sample.correlation < config.least_share * best;
  });
  std::vector<Moments> clusters(static_cast<std::size_t>(gather(config.valley_share)),
                                Moments(prior.pose));
  Moments all(prior.pose);
  for (const Sample& sample : samples_) {
    all.add(sample);
    clusters[static_cast<std::size_t>(sample.cluster)].add(sample);
  }
  result.map_from_base = all.gaussian(draws.size());
  result.clusters.clear();
  for (const Moments& cluster : clusters)
    result.clusters.push_back({cluster.gaussian(draws.size()), cluster.weight() / all.weight()});
  std::ranges::stable_sort(result.clusters, std::ranges::greater{}, &PoseCluster::weight);
  return result;
}

}  // namespace slammot::matching
