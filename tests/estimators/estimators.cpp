// Least squares and the Kalman filter over the same pose graphs: error, consistency and cost
// against the number of submaps.
//
//   estimators                        simulated drives through a grid of streets, with truth
//   estimators GRAPH.g2o[.gz] ...     the first submaps of recorded pose graphs, against least
//   squares over all constraints
//
// Closures arrive in the order of the drive, and each is followed by a solve, as in loop closing.
// The rows are those of docs/performance.md.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Cholesky>

#include "common/graphs/pose_graph.hpp"
#include "tests/support/g2o_graph.hpp"

namespace slammot {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using graphs::Estimator;
using graphs::PoseGraph;

struct Drive {
  std::vector<Constraint> constraints;  ///< By their later end; the odometric one first.
  std::vector<Pose2> truth;
};

struct Score {
  double ate_m = 0.0;    ///< Root mean square of the position error, first node held.
  double nees = 0.0;     ///< Mean over nodes, 3 degrees of freedom; NaN without a covariance.
  double cost_ms = 0.0;  ///< Processor time of one solve at full size.
};

double processor_time_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

PoseGraph solved(const Drive& drive, Estimator estimator, double& last_solve_ms) {
  PoseGraph graph({.estimator = estimator});
  graph.add_node(SubmapId{0}, drive.truth.front());
  for (std::size_t i = 0; i < drive.constraints.size(); ++i) {
    const Constraint& constraint = drive.constraints[i];
    if (!graph.contains(constraint.to))
      graph.add_node(constraint.to, graph.map_from_node(constraint.from) * constraint.from_to.pose);
    graph.add_constraint(constraint);
    const bool is_last_of_node =
        i + 1 == drive.constraints.size() || drive.constraints[i + 1].to != constraint.to;
    if (constraint.kind != ConstraintKind::kLoop || !is_last_of_node) continue;
    const double begin_ms = processor_time_ms();
    graph.optimise();
    last_solve_ms = processor_time_ms() - begin_ms;
  }
  graph.optimise();
  return graph;
}

Score score(const Drive& drive, Estimator estimator) {
  Score score;
  const PoseGraph graph = solved(drive, estimator, score.cost_ms);
  const auto covariances = graph.covariances();
  const auto nodes = static_cast<double>(drive.truth.size() - 1);
  for (std::uint32_t i = 1; i < drive.truth.size(); ++i) {
    const Eigen::Vector3d error =
        geometry::difference(graph.map_from_node(SubmapId{i}), drive.truth[i]);
    score.ate_m += error.head<2>().squaredNorm() / nodes;
    score.nees += error.dot(covariances.at(SubmapId{i}).ldlt().solve(error)) / nodes;
  }
  score.ate_m = std::sqrt(score.ate_m);
  return score;
}

Pose2 drawn(const Pose2& truth, const Matrix3& covariance, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  const double heading = normal(random);
  const Eigen::Vector3d error =
      covariance.diagonal().cwiseSqrt().cwiseProduct(Eigen::Vector3d(x, y, heading));
  return {truth.x_m + error.x(), truth.y_m + error.y(), truth.heading_rad + error.z()};
}

/// A drive of submaps of 40 m through a town of 6 x 6 junctions, 80 m apart, with random turns. A
/// submap is closed on the latest one at its place in the same direction, at least 5 submaps ago.
Drive simulated(std::size_t submaps, std::uint64_t seed) {
  constexpr int kJunctions = 6;
  constexpr double kSubmap_m = 40.0;
  const Matrix3 step_covariance = Eigen::Vector3d(0.01, 0.01, 9e-6).asDiagonal();
  const Matrix3 closure_covariance = Eigen::Vector3d(0.0025, 0.0025, 4e-6).asDiagonal();
  std::mt19937_64 random(seed);
  Drive drive{{}, {Pose2::identity()}};
  while (drive.truth.size() < submaps) {
    const Pose2& last = drive.truth.back();
    const bool is_at_junction = drive.truth.size() % 2 == 1;
    Pose2 next;
    do {
      const int turn = is_at_junction ? static_cast<int>(random() % 3) - 1 : 0;
      next = last * Pose2{0.0, 0.0, turn * std::numbers::pi / 2} * Pose2{kSubmap_m, 0.0, 0.0};
    } while (std::min(next.x_m, next.y_m) < -1.0 ||
             std::max(next.x_m, next.y_m) > 2.0 * kSubmap_m * kJunctions + 1.0);
    const auto id = static_cast<std::uint32_t>(drive.truth.size());
    drive.truth.push_back(next);
    drive.constraints.push_back(
        {SubmapId{id - 1},
         SubmapId{id},
         ConstraintKind::kOdometric,
         {drawn(inverse(last) * next, step_covariance, random), step_covariance}});
    for (std::uint32_t other = id; other-- > 5;) {
      const Pose2 apart = inverse(drive.truth[other - 5]) * next;
      if (apart.translation_m().norm() > 1.0 || std::abs(apart.heading_rad) > 0.1) continue;
      drive.constraints.push_back({SubmapId{other - 5},
                                   SubmapId{id},
                                   ConstraintKind::kLoop,
                                   {drawn(apart, closure_covariance, random), closure_covariance}});
      break;
    }
  }
  return drive;
}

/// The first submaps of a recorded graph; least squares over all their constraints takes the place
/// of the truth.
Drive recorded(const std::string& path, std::size_t submaps) {
  Drive drive;
  const auto graph = slammot::testing::parse_g2o(slammot::testing::read_text(path));
  std::vector<std::vector<Constraint>> by_end(submaps);
  for (Constraint one : graph.constraints) {
    if (one.from > one.to) {
      std::swap(one.from, one.to);
      one.from_to = geometry::inverse(one.from_to);
    }
    if (one.to.value >= submaps) continue;
    one.kind =
        one.to.value == one.from.value + 1 ? ConstraintKind::kOdometric : ConstraintKind::kLoop;
    auto& ending = by_end[one.to.value];
    ending.insert(one.kind == ConstraintKind::kOdometric ? ending.begin() : ending.end(), one);
  }
  for (const auto& ending : by_end)
    drive.constraints.insert(drive.constraints.end(), ending.begin(), ending.end());
  drive.truth = {Pose2::identity()};
  double ignored_ms = 0.0;
  const PoseGraph reference = solved(drive, Estimator::kGraph, ignored_ms);
  drive.truth.clear();
  for (const auto& node : reference.nodes()) drive.truth.push_back(node.map_from_submap);
  return drive;
}

void print_simulated() {
  std::printf(
      "| submaps | closures | ATE (m), graph / ekf | NEES, graph / ekf | one solve (ms), graph / "
      "ekf |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const std::size_t submaps : {21U, 50U, 100U, 200U, 400U}) {
    Score graph;
    Score ekf;
    double closures = 0.0;
    const int drives = submaps > 100 ? 5 : 20;
    for (int seed = 1; seed <= drives; ++seed) {
      const Drive drive = simulated(submaps, static_cast<std::uint64_t>(seed));
      closures += static_cast<double>(drive.constraints.size() + 1 - submaps) / drives;
      for (const auto& [estimator, sum] :
           {std::pair{Estimator::kGraph, &graph}, {Estimator::kEkf, &ekf}}) {
        const Score one = score(drive, estimator);
        sum->ate_m += one.ate_m / drives;
        sum->nees += one.nees / drives;
        sum->cost_ms += one.cost_ms / drives;
      }
    }
    std::printf("| %zu | %.0f | %.3f / %.3f | %.2f / %.2f | %.2f / %.2f |\n", submaps, closures,
                graph.ate_m, ekf.ate_m, graph.nees, ekf.nees, graph.cost_ms, ekf.cost_ms);
  }
}

void print_recorded(const std::string& path) {
  for (const std::size_t submaps : {100U, 200U, 400U}) {
    const Drive drive = recorded(path, submaps);
    const Score graph = score(drive, Estimator::kGraph);
    const Score ekf = score(drive, Estimator::kEkf);
    std::printf("| %s, first %zu | %zu | %.3f | %.2f / %.2f |\n",
                path.substr(path.rfind('/') + 1).c_str(), submaps,
                drive.constraints.size() + 1 - submaps, ekf.ate_m, graph.cost_ms, ekf.cost_ms);
  }
}

}  // namespace
}  // namespace slammot

int main(int argc, char** argv) {
  if (argc == 1) {
    slammot::print_simulated();
    return 0;
  }
  std::printf(
      "| graph | closures | ekf away from graph, RMS (m) | one solve (ms), graph / ekf "
      "|\n|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) slammot::print_recorded(argv[i]);
  return 0;
}
