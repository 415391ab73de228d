#include "services/loop_closing/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace slammot::loop_closing {
namespace {

using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kGateSigmas = 3.0;     // Gate of the graph's uncertainty, in addition to
                                        // max_distance_m.
constexpr double kGnssReach_m = 100.0;  // Errors of two submaps' fixes together: multipath in a
                                        // street canyon may last for both.
constexpr int kNeighbours = 1;     // Submaps before and after the earlier one that join its target.
constexpr int kMaxCandidates = 3;  // Targets on the same island for one new submap.

struct Candidate {
  SubmapId id;
  UncertainPose2 target_from_source;
  double distance_m = 0.0;
};

/// Largest standard deviation of the position over all directions [m].
double widest_sigma_m(const Matrix3& covariance) {
  const double half_trace = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half_difference = 0.5 * (covariance(0, 0) - covariance(1, 1));
  return std::sqrt(half_trace + std::hypot(half_difference, covariance(0, 1)));
}

/// Prior of a target on another island: centres coincide, sigma_m in position, any heading.
UncertainPose2 unknown_pose_on(const Place& target, const Place& source, double sigma_m) {
  const Vector2 shift_m = target.centre_m - source.centre_m;
  return {{shift_m.x(), shift_m.y(), 0.0},
          Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, std::numbers::pi * std::numbers::pi)
              .asDiagonal()};
}

/// Distance of two submaps that GNSS is sure of [m]; none if it does not say that they are apart.
std::optional<double> apart_by_gnss_m(const SubmapView& submaps, const Place& a, const Place& b) {
  if (!submaps.gnss_is_sound || !a.by_gnss || !b.by_gnss) return std::nullopt;
  const double sure_m = geometry::east_north_m(*a.by_gnss, *b.by_gnss).norm() - kGnssReach_m;
  return sure_m > submaps.config.max_distance_m ? std::optional(sure_m) : std::nullopt;
}

/// True if two submaps of an island overlap by the graph within its uncertainty. A distance by GNSS
/// that the graph excludes is an error of GNSS, such as a jump by kilometres.
bool may_overlap(const SubmapView& submaps, const Place& target, const Place& source,
                 double distance_m, double sigma_m) {
  const double reach_m = kGateSigmas * sigma_m;
  if (distance_m > submaps.config.max_distance_m + reach_m) return false;
  const auto apart_m = apart_by_gnss_m(submaps, target, source);
  return !apart_m || *apart_m > distance_m + reach_m;
}

/// The nearest candidates. Neighbours of a chosen candidate are part of its target.
std::vector<Candidate> nearest(std::vector<Candidate> all, int most) {
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_m < b.distance_m;
  });
  std::vector<Candidate> chosen;
  for (const Candidate& candidate : all) {
    if (static_cast<int>(chosen.size()) >= most) break;
    const bool is_covered = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& one) {
      return std::abs(static_cast<double>(one.id.value) - candidate.id.value) <= kNeighbours;
    });
    if (!is_covered) chosen.push_back(candidate);
  }
  return chosen;
}

std::vector<RevisitCandidate> as_candidates(const SubmapView& submaps,
                                            const std::vector<Candidate>& chosen,
                                            const Place& source) {
  std::vector<RevisitCandidate> candidates;
  for (const Candidate& one : chosen)
    candidates.push_back({target_around(submaps, one.id, source), one.target_from_source,
                          submaps.graph.map_from_node(one.id)});
  return candidates;
}

}  // namespace

Target target_around(const SubmapView& submaps, SubmapId id, const Place& source) {
  const auto& [config, places, graph, gnss_is_sound] = submaps;
  Target target{{{&places.at(id), Pose2::identity()}}};
  const Pose2 target_from_map = geometry::inverse(graph.map_from_node(id));
  for (int step = -kNeighbours; step <= kNeighbours; ++step) {
    const auto found =
        places.find({static_cast<std::uint32_t>(static_cast<std::int64_t>(id.value) + step)});
    if (step == 0 || found == places.end() || !graph.are_on_one_island(found->first, id)) continue;
    if (source.travelled_before_m - found->second.travelled_after_m < config.min_travel_between_m)
      continue;
    target.members.push_back({&found->second, target_from_map * graph.map_from_node(found->first)});
  }
  return target;
}

std::vector<RevisitCandidate> expected_candidates(const SubmapView& submaps, const Place& source) {
  const LoopClosingConfig& config = submaps.config;
  std::vector<Candidate> all;
  for (const auto& [id, source_from_target] : submaps.graph.expectations_from(source.id)) {
    const Place& target = submaps.places.at(id);
    if (target.is_superseded) continue;
    if (source.travelled_before_m - target.travelled_after_m < config.min_travel_between_m)
      continue;
    const double distance_m = (source_from_target.pose * target.centre_m - source.centre_m).norm();
    if (!may_overlap(submaps, target, source, distance_m,
                     widest_sigma_m(source_from_target.covariance)))
      continue;
    all.push_back({id, geometry::inverse(source_from_target), distance_m});
  }
  return as_candidates(submaps, nearest(std::move(all), kMaxCandidates), source);
}

std::vector<RevisitCandidate> candidates_elsewhere(const SubmapView& submaps, const Place& source) {
  const ClosureGraph& graph = submaps.graph;
  const Vector2 source_in_map_m = graph.map_from_node(source.id) * source.centre_m;
  std::vector<Candidate> all;
  for (const auto& [id, target] : submaps.places) {
    if (target.is_superseded || graph.are_on_one_island(id, source.id) ||
        apart_by_gnss_m(submaps, target, source))
      continue;
    all.push_back({id, unknown_pose_on(target, source, submaps.config.max_distance_m),
                   (graph.map_from_node(id) * target.centre_m - source_in_map_m).norm()});
  }
  return as_candidates(submaps, nearest(std::move(all), submaps.config.most_targets_elsewhere),
                       source);
}

}  // namespace slammot::loop_closing
