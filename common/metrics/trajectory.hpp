#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::metrics {

/// A pose in the frame of its trajectory.
struct StampedPose {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 pose;
};

/// Ascending stamps.
using Trajectory = std::vector<StampedPose>;

/// Poses of both trajectories at the same time.
struct PosePair {
  std::int64_t stamp_ns = 0;  ///< Of the estimate.
  geometry::Pose2 truth;      ///< world_from_base
  geometry::Pose2 estimate;   ///< map_from_base
};

/// Each pose of the shorter trajectory with the nearest in time of the longer one, as PyPI `evo`
/// does; none where that is farther than max_difference_ns.
std::vector<PosePair> associate(const Trajectory& truth, const Trajectory& estimate,
                                std::int64_t max_difference_ns);

/// Pose at the stamp, between the two nearest; none outside the trajectory or in a gap longer than
/// longest_gap_ns.
std::optional<geometry::Pose2> pose_at(const Trajectory& trajectory, std::int64_t stamp_ns,
                                       std::int64_t longest_gap_ns);

/// world_from_map that brings the estimate's positions nearest to the true ones (least squares, no
/// scale): Umeyama 1991, in the plane. What `evo_ape -a` does with planar trajectories. Identity
/// for no pairs.
geometry::Pose2 align_rigidly(const std::vector<PosePair>& pairs);

/// world_from_map that makes the first poses equal; identity for no pairs.
geometry::Pose2 align_first_pose(const std::vector<PosePair>& pairs);

/// Distances between true positions and estimated ones, brought into the world's frame; one a pair.
/// [m]
std::vector<double> absolute_errors_m(const std::vector<PosePair>& pairs,
                                      const geometry::Pose2& world_from_map);

enum class PathPairs {
  kConsecutive,  ///< A pair begins where the last one ended: the default of `evo_rpe -d N -u m`.
  kAll,          ///< A pair begins at each pose: `evo_rpe --all_pairs`.
};

struct IndexPair {
  std::size_t from = 0;
  std::size_t to = 0;
};

/// Pairs of poses between which the path is delta_m long. Consecutive: each ends at the first pose
/// where the path is at least that. All: each ends where the path is nearest to that, and is left
/// out where it is off by more than a tenth.
std::vector<IndexPair> pairs_by_path(const std::vector<geometry::Pose2>& poses, double delta_m,
                                     PathPairs pairing);

struct RelativeError {
  std::int64_t stamp_ns = 0;  ///< End of the pair.
  double translation_m = 0.0;
  double rotation_rad = 0.0;
};

/// Relative pose error of each pair of indices, as `evo_rpe` defines it (trans_part, angle).
std::vector<RelativeError> relative_errors(const std::vector<PosePair>& pairs,
                                           const std::vector<IndexPair>& ends);

/// A published pose with its covariance relative to the local map.
struct UncertainStampedPose {
  std::int64_t stamp_ns = 0;
  geometry::UncertainPose2 odom_from_base;
};

/// NEES, three degrees of freedom each, of the motion between poses interval_ns apart, one interval
/// after the other so that no two overlap. The motion's covariance is that of the tail-to-tail
/// operation (Wang 2004, Eqs. (2.9)-(2.10)) on the two published ones. Stamps are matched within
/// max_difference_ns.
std::vector<double> relative_pose_nees(const Trajectory& truth,
                                       const std::vector<UncertainStampedPose>& estimate,
                                       std::int64_t interval_ns, std::int64_t max_difference_ns);

}  // namespace slammot::metrics
