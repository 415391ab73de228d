#include "common/metrics/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/Cholesky>

namespace slammot::metrics {
namespace {

using geometry::Pose2;
using geometry::Vector2;

const StampedPose* nearest(const Trajectory& trajectory, std::int64_t stamp_ns,
                           std::int64_t max_difference_ns) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), stamp_ns,
      [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  const StampedPose* best = nullptr;
  const auto consider = [&](const StampedPose& pose) {
    const std::int64_t difference_ns = std::abs(pose.stamp_ns - stamp_ns);
    if (difference_ns <= max_difference_ns &&
        (!best || difference_ns < std::abs(best->stamp_ns - stamp_ns)))
      best = &pose;
  };
  if (after != trajectory.begin()) consider(*std::prev(after));
  if (after != trajectory.end()) consider(*after);
  return best;
}

std::vector<double> path_m(const std::vector<Pose2>& poses) {
  std::vector<double> sums_m(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    sums_m[i] = sums_m[i - 1] + (poses[i].translation_m() - poses[i - 1].translation_m()).norm();
  }
  return sums_m;
}

std::vector<IndexPair> consecutive_pairs(const std::vector<Pose2>& poses, double delta_m) {
  std::vector<IndexPair> pairs;
  std::size_t from = 0;
  double since_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    since_m += (poses[i].translation_m() - poses[i - 1].translation_m()).norm();
    if (since_m < delta_m) continue;
    pairs.push_back({from, i});
    from = i;
    since_m = 0.0;
  }
  return pairs;
}

std::vector<IndexPair> all_pairs(const std::vector<Pose2>& poses, double delta_m) {
  constexpr double kTolerance = 0.1;  // evo's default
  const std::vector<double> path = path_m(poses);
  std::vector<IndexPair> pairs;
  for (std::size_t from = 0; from + 1 < path.size(); ++from) {
    const auto first = path.begin() + static_cast<std::ptrdiff_t>(from) + 1;
    const auto off_by_m = [&](auto place) { return std::abs(*place - path[from] - delta_m); };
    auto best = std::lower_bound(first, path.end(), path[from] + delta_m);
    if (best == path.end()) --best;
    // The first pose of a rest counts, not the last.
    if (best != first) {
      const auto before = std::lower_bound(first, best, *std::prev(best));
      if (off_by_m(before) <= off_by_m(best)) best = before;
    }
    if (off_by_m(best) <= kTolerance * delta_m)
      pairs.push_back({from, static_cast<std::size_t>(best - path.begin())});
  }
  return pairs;
}

Pose2 motion(const Pose2& from, const Pose2& to) { return geometry::inverse(from) * to; }

}  // namespace

std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                std::int64_t max_difference_ns) {
  std::vector<PosePair> pairs;
  if (estimate.size() <= truth.size()) {
    for (const StampedPose& pose : estimate) {
      if (const StampedPose* match = nearest(truth, pose.stamp_ns, max_difference_ns))
        pairs.push_back({pose.stamp_ns, match->pose, pose.pose});
    }
  } else {
    for (const StampedPose& pose : truth) {
      if (const StampedPose* match = nearest(estimate, pose.stamp_ns, max_difference_ns))
        pairs.push_back({match->stamp_ns, pose.pose, match->pose});
    }
  }
  return pairs;
}

std::optional<Pose2> pose_at(const Trajectory& trajectory, std::int64_t stamp_ns,
                             std::int64_t longest_gap_ns) {
  const auto after = std::lower_bound(
      trajectory.begin(), trajectory.end(), stamp_ns,
      [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  if (after == trajectory.end()) return std::nullopt;
  if (after->stamp_ns == stamp_ns) return after->pose;
  if (after == trajectory.begin() || after->stamp_ns - std::prev(after)->stamp_ns > longest_gap_ns)
    return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const double fraction = static_cast<double>(stamp_ns - before.stamp_ns) /
                          static_cast<double>(after->stamp_ns - before.stamp_ns);
  return geometry::interpolate(before.pose, after->pose, fraction);
}

Pose2 align_rigidly(const std::vector<PosePair>& pairs) {
  if (pairs.empty()) return Pose2::identity();
  Vector2 true_mean_m = Vector2::Zero();
  Vector2 estimated_mean_m = Vector2::Zero();
  for (const PosePair& pair : pairs) {
    true_mean_m += pair.truth.translation_m() / static_cast<double>(pairs.size());
    estimated_mean_m += pair.estimate.translation_m() / static_cast<double>(pairs.size());
  }
  double along = 0.0;
  double across = 0.0;
  for (const PosePair& pair : pairs) {
    const Vector2 truth_m = pair.truth.translation_m() - true_mean_m;
    const Vector2 estimate_m = pair.estimate.translation_m() - estimated_mean_m;
    along += estimate_m.dot(truth_m);
    across += estimate_m.x() * truth_m.y() - estimate_m.y() * truth_m.x();
  }
  const double heading_rad = std::atan2(across, along);
  const Vector2 origin_m = true_mean_m - geometry::rotation(heading_rad) * estimated_mean_m;
  return {origin_m.x(), origin_m.y(), heading_rad};
}

Pose2 align_first_pose(const std::vector<PosePair>& pairs) {
  return pairs.empty() ? Pose2::identity()
                       : pairs.front().truth * geometry::inverse(pairs.front().estimate);
}

std::vector<double> absolute_errors_m(const std::vector<PosePair>& pairs,
                                      const Pose2& world_from_map) {
  std::vector<double> errors_m;
  errors_m.reserve(pairs.size());
  for (const PosePair& pair : pairs) {
    errors_m.push_back(
        (world_from_map * pair.estimate.translation_m() - pair.truth.translation_m()).norm());
  }
  return errors_m;
}

std::vector<IndexPair> pairs_by_path(const std::vector<Pose2>& poses, double delta_m,
                                     PathPairs pairing) {
  return pairing == PathPairs::kConsecutive ? consecutive_pairs(poses, delta_m)
                                            : all_pairs(poses, delta_m);
}

std::vector<RelativeError> relative_errors(const std::vector<PosePair>& pairs,
                                           const std::vector<IndexPair>& ends) {
  std::vector<RelativeError> errors;
  errors.reserve(ends.size());
  for (const auto& [from, to] : ends) {
    const Pose2 error = motion(motion(pairs[from].truth, pairs[to].truth),
                               motion(pairs[from].estimate, pairs[to].estimate));
    errors.push_back(
        {pairs[to].stamp_ns, error.translation_m().norm(), std::abs(error.heading_rad)});
  }
  return errors;
}

std::vector<double> relative_pose_nees(const Trajectory& truth,
                                       const std::vector<UncertainStampedPose>& estimate,
                                       std::int64_t interval_ns, std::int64_t max_difference_ns) {
  std::vector<double> nees;
  const UncertainStampedPose* from = nullptr;
  for (const UncertainStampedPose& to : estimate) {
    const StampedPose* const true_to = nearest(truth, to.stamp_ns, max_difference_ns);
    if (!true_to) continue;
    if (from && to.stamp_ns - from->stamp_ns < interval_ns) continue;
    if (from && to.stamp_ns - from->stamp_ns < interval_ns + interval_ns / 2) {
      const geometry::UncertainPose2 moved =
          geometry::tail_to_tail(from->odom_from_base, to.odom_from_base);
      const Pose2 truly_moved =
          motion(nearest(truth, from->stamp_ns, max_difference_ns)->pose, true_to->pose);
      const Eigen::Vector3d error = geometry::difference(moved.pose, truly_moved);
      nees.push_back(error.dot(moved.covariance.ldlt().solve(error)));
    }
    from = &to;
  }
  return nees;
}

}  // namespace slammot::metrics
