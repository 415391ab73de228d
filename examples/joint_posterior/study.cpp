#include "examples/joint_posterior/study.hpp"

#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "examples/joint_posterior/joint_filter.hpp"

namespace slammot::joint_posterior {
namespace {

constexpr int kPeriods = 300;
constexpr int kUnscoredPeriods = 25;

/// One of the methods at work.
class Estimator {
 public:
  Estimator(Method method, std::size_t landmarks) : method_(method), landmarks_(landmarks) {}

  void step(const Control& control, const std::vector<Observation>& observations) {
    filter_.predict(control);
    for (auto& [object, track] : tracks_) track.predict();
    // Known objects first: a new one is placed by the best pose.
    std::map<std::size_t, bool> is_seen;
    for (const Observation& one : observations) {
      if (is_in_filter(one.object) && slots_.contains(one.object))
        filter_.update(slots_.at(one.object), one.range_bearing);
    }
    for (const Observation& one : observations) {
      if (!is_in_filter(one.object)) is_seen[one.object] = true, track(one);
      else if (!slots_.contains(one.object))
        slots_[one.object] = filter_.add(kind_of(one.object), one.range_bearing);
    }
    for (auto& [object, track] : tracks_) {
      if (!is_seen[object]) track.miss();
    }
  }

  bool knows(std::size_t object) const {
    return is_in_filter(object) ? slots_.contains(object) : tracks_.contains(object);
  }
  ObjectEstimate estimate(std::size_t object) const {
    return is_in_filter(object) ? filter_.estimate(slots_.at(object)) : tracks_.at(object).estimate;
  }
  const JointFilter& filter() const { return filter_; }
  double numbers() const {
    const auto size = static_cast<double>(filter_.size());
    return size * size + 16.0 * static_cast<double>(tracks_.size());
  }

 private:
  bool is_in_filter(std::size_t object) const {
    return object < landmarks_ || method_ == Method::kGeneric || method_ == Method::kJoint;
  }
  ObjectKind kind_of(std::size_t object) const {
    return object < landmarks_ && method_ != Method::kGeneric ? ObjectKind::kLandmark
                                                              : ObjectKind::kGeneric;
  }

  /// Equation (2.68): the pose's marginal is part of the measurement's covariance.
  void track(const Observation& one) {
    const ObservedPlace seen = observed_place(filter_.world_from_base(), one.range_bearing);
    Eigen::Matrix2d covariance_m2 =
        seen.by_observation * observation_covariance() * seen.by_observation.transpose();
    if (method_ == Method::kDecomposed)
      covariance_m2 += seen.by_pose * filter_.pose_covariance() * seen.by_pose.transpose();
    const auto known = tracks_.find(one.object);
    if (known == tracks_.end()) {
      HybridTrack track;
      track.estimate = begin_at(seen.place_m, covariance_m2);
      track.predicted = {track.estimate, track.estimate};
      tracks_.emplace(one.object, track);
    } else {
      known->second.update(seen.place_m, covariance_m2);
    }
  }

  Method method_;
  std::size_t landmarks_;
  JointFilter filter_;
  std::map<std::size_t, std::size_t> slots_;  ///< In the filter, of each object.
  std::map<std::size_t, HybridTrack> tracks_;
};

/// Sums of squares and their counts.
struct Sums {
  double pose_m2 = 0.0, heading_rad2 = 0.0, pose_nees = 0.0;
  double mover_m2 = 0.0, velocity_m2ps2 = 0.0, mover_nees = 0.0;
  std::size_t poses = 0, movers = 0;
};

void add_pose(Sums& sums, const Estimator& estimator, const World& world) {
  const Eigen::Vector3d error =
      geometry::difference(estimator.filter().world_from_base(), world.world_from_base());
  sums.pose_m2 += error.head<2>().squaredNorm();
  sums.heading_rad2 += error[2] * error[2];
  sums.pose_nees += error.dot(estimator.filter().pose_covariance().ldlt().solve(error)) / 3.0;
  ++sums.poses;
}

/// Of the movers that are seen.
void add_movers(Sums& sums, const Estimator& estimator, const World& world,
                const std::vector<Observation>& observations) {
  for (const Observation& one : observations) {
    if (one.object < world.landmarks() || !estimator.knows(one.object)) continue;
    const PointObject& truth = world.objects()[one.object];
    const ObjectEstimate estimate = estimator.estimate(one.object);
    const Eigen::Vector2d error_m = estimate.mean.head<2>() - truth.place_m;
    const Eigen::Matrix2d P = estimate.covariance.topLeftCorner<2, 2>();
    sums.mover_m2 += error_m.squaredNorm();
    sums.velocity_m2ps2 += (estimate.mean.tail<2>() - truth.velocity_mps).squaredNorm();
    sums.mover_nees += error_m.dot(P.ldlt().solve(error_m)) / 2.0;
    ++sums.movers;
  }
}

}  // namespace

std::string_view name_of(Method method) {
  switch (method) {
    case Method::kGeneric: return "one filter, generic objects (2.4)";
    case Method::kJoint: return "one filter, landmarks known";
    case Method::kDecomposed: return "two estimators (2.5)";
    case Method::kPoseTakenAsTrue: return "two, pose taken as true";
  }
  return "";
}

Score score_of(Method method, const Crowd& crowd, int seeds, const Clock& now_s) {
  Sums sums;
  Score score;
  double spent_s = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    World world(crowd.landmarks, crowd.movers, static_cast<std::uint64_t>(seed));
    Estimator estimator(method, crowd.landmarks);
    for (int period = 0; period < kPeriods; ++period) {
      const Control control = world.advance();
      const std::vector<Observation> observations = world.observe();
      const double begin_s = now_s();
      estimator.step(control, observations);
      spent_s += now_s() - begin_s;
      if (period < kUnscoredPeriods) continue;
      add_pose(sums, estimator, world);
      add_movers(sums, estimator, world, observations);
    }
    score.numbers += estimator.numbers() / seeds;
  }
  const auto poses = static_cast<double>(sums.poses);
  const auto movers = static_cast<double>(std::max<std::size_t>(sums.movers, 1));
  score.pose_rmse_m = std::sqrt(sums.pose_m2 / poses);
  score.heading_rmse_rad = std::sqrt(sums.heading_rad2 / poses);
  score.pose_nees = sums.pose_nees / poses;
  score.mover_rmse_m = std::sqrt(sums.mover_m2 / movers);
  score.velocity_rmse_mps = std::sqrt(sums.velocity_m2ps2 / movers);
  score.mover_nees = sums.mover_nees / movers;
  score.step_us = 1e6 * spent_s / (kPeriods * seeds);
  return score;
}

}  // namespace slammot::joint_posterior
