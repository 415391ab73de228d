// Least squares and the Kalman filter over the same pose graphs: error, consistency and cost
// against the number of submaps.
//
//   estimators sizes                  simulated drives through a grid of streets, with truth
//   estimators headings               the same with more and more uncertain headings
//   estimators GRAPH.g2o[.gz] ...     the first submaps of recorded pose graphs, against least
//   squares over all constraints
//
// Closures arrive in the order of the drive, and each is followed by a solve, as in loop closing.
// tests/estimators/compare puts the tables into docs/thesis.md.

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
#include "tests/estimators/thesis_filter.hpp"
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
  double ate_m = 0.0;          ///< Root mean square of the position error, first node held.
  double nees = 0.0;           ///< Mean over nodes, 3 degrees of freedom.
  double cost_ms = 0.0;        ///< Processor time of the last solve.
  double withdrawal_ms = 0.0;  ///< Processor time of a solve without the last closure.
};

double processor_time_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double optimisation_ms(PoseGraph& graph) {
  const double begin_ms = processor_time_ms();
  graph.optimise();
  return processor_time_ms() - begin_ms;
}

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
    if (constraint.kind == ConstraintKind::kLoop && is_last_of_node)
      last_solve_ms = optimisation_ms(graph);
  }
  graph.optimise();
  return graph;
}

double withdrawal_ms(PoseGraph graph) {
  std::size_t last = graph.constraints().size();
  while (last > 0 && graph.constraints()[last - 1].kind != ConstraintKind::kLoop) --last;
  if (last == 0) return 0.0;
  graph.set_enabled(last - 1, false);
  return optimisation_ms(graph);
}

template <typename PoseOf, typename CovarianceOf>
Score errors(const std::vector<Pose2>& truth, PoseOf pose_of, CovarianceOf covariance_of) {
  Score score;
  const auto nodes = static_cast<double>(truth.size() - 1);
  for (std::uint32_t i = 1; i < truth.size(); ++i) {
    const Eigen::Vector3d error = geometry::difference(pose_of(i), truth[i]);
    score.ate_m += error.head<2>().squaredNorm() / nodes;
    score.nees += error.dot(covariance_of(i).ldlt().solve(error)) / nodes;
  }
  score.ate_m = std::sqrt(score.ate_m);
  return score;
}

Score score(const Drive& drive, Estimator estimator) {
  double cost_ms = 0.0;
  const PoseGraph graph = solved(drive, estimator, cost_ms);
  const auto covariances = graph.covariances();
  Score score = errors(
      drive.truth, [&](std::uint32_t i) { return graph.map_from_node(SubmapId{i}); },
      [&](std::uint32_t i) { return covariances.at(SubmapId{i}); });
  score.cost_ms = cost_ms;
  score.withdrawal_ms = withdrawal_ms(graph);
  return score;
}

Score score_of_thesis(const Drive& drive) {
  estimators::ThesisFilter filter;
  filter.add_known(drive.truth.front());
  for (const Constraint& constraint : drive.constraints) {
    if (constraint.to.value == filter.size())
      filter.predict(constraint.from.value, constraint.from_to);
    else filter.update(constraint.from.value, constraint.to.value, constraint.from_to);
  }
  return errors(
      drive.truth, [&](std::uint32_t i) { return filter.pose(i); },
      [&](std::uint32_t i) { return filter.covariance(i); });
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
Drive simulated(std::size_t submaps, std::uint64_t seed, double heading_sigma_rad = 0.003) {
  constexpr int kJunctions = 6;
  constexpr double kSubmap_m = 40.0;
  const Matrix3 step_covariance =
      Eigen::Vector3d(0.01, 0.01, heading_sigma_rad * heading_sigma_rad).asDiagonal();
  const Matrix3 closure_covariance = Eigen::Vector3d(0.0025, 0.0025, 4e-6).asDiagonal();
  std::mt19937_64 random(seed);
  Drive drive{{}, {Pose2::identity()}};
  while (drive.truth.size() < submaps) {
    const Pose2 last = drive.truth.back();
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

void add(const Score& one, int drives, Score& sum) {
  sum.ate_m += one.ate_m / drives;
  sum.nees += one.nees / drives;
  sum.cost_ms += one.cost_ms / drives;
  sum.withdrawal_ms += one.withdrawal_ms / drives;
}

void print_sizes() {
  std::printf(
      "| submaps | closures | ATE (m), graph / ekf | NEES, graph / ekf | one closure (ms), graph / "
      "ekf | one withdrawal (ms), graph / ekf |\n|---|---|---|---|---|---|\n");
  for (const std::size_t submaps : {14U, 21U, 50U, 100U, 200U, 400U, 800U}) {
    Score graph;
    Score ekf;
    double closures = 0.0;
    const int drives = submaps > 400 ? 2 : submaps > 100 ? 5 : 40;
    for (int seed = 1; seed <= drives; ++seed) {
      const Drive drive = simulated(submaps, static_cast<std::uint64_t>(seed));
      closures += static_cast<double>(drive.constraints.size() + 1 - submaps) / drives;
      add(score(drive, Estimator::kGraph), drives, graph);
      add(score(drive, Estimator::kEkf), drives, ekf);
    }
    std::printf("| %zu | %.0f | %.3f / %.3f | %.2f / %.2f | %.3f / %.3f | %.3f / %.3f |\n", submaps,
                closures, graph.ate_m, ekf.ate_m, graph.nees, ekf.nees, graph.cost_ms, ekf.cost_ms,
                graph.withdrawal_ms, ekf.withdrawal_ms);
  }
}

void print_headings() {
  constexpr std::size_t kSubmaps = 100;
  constexpr int kDrives = 40;
  std::printf(
      "| heading sigma a submap (mrad) | ATE (m), graph / ekf / ekf of the thesis | NEES, graph / "
      "ekf / ekf of the thesis |\n|---|---|---|\n");
  for (const double sigma_rad : {0.001, 0.003, 0.01, 0.03, 0.06}) {
    Score graph;
    Score ekf;
    Score thesis;
    for (int seed = 1; seed <= kDrives; ++seed) {
      const Drive drive = simulated(kSubmaps, static_cast<std::uint64_t>(seed), sigma_rad);
      add(score(drive, Estimator::kGraph), kDrives, graph);
      add(score(drive, Estimator::kEkf), kDrives, ekf);
      add(score_of_thesis(drive), kDrives, thesis);
    }
    std::printf("| %.0f | %.3f / %.3f / %.3f | %.2f / %.2f / %.2f |\n", 1e3 * sigma_rad,
                graph.ate_m, ekf.ate_m, thesis.ate_m, graph.nees, ekf.nees, thesis.nees);
  }
}

void print_recorded(const std::string& path) {
  for (const std::size_t submaps : {100U, 200U, 400U}) {
    const Drive drive = recorded(path, submaps);
    const Score graph = score(drive, Estimator::kGraph);
    const Score ekf = score(drive, Estimator::kEkf);
    const std::string name = path.substr(path.rfind('/') + 1);
    std::printf("| `%s`, first %zu | %zu | %.3f | %.2f / %.2f |\n",
                name.substr(0, name.find('.')).c_str(), submaps,
                drive.constraints.size() + 1 - submaps, ekf.ate_m, graph.cost_ms, ekf.cost_ms);
  }
}

}  // namespace
}  // namespace slammot

int main(int argc, char** argv) {
  const std::string what = argc == 2 ? argv[1] : "";
  if (what == "sizes") {
    slammot::print_sizes();
  } else if (what == "headings") {
    slammot::print_headings();
  } else {
    std::printf(
        "| graph | closures | ekf away from graph, RMS (m) | one closure (ms), graph / ekf "
        "|\n|---|---|---|---|\n");
    for (int i = 1; i < argc; ++i) slammot::print_recorded(argv[i]);
  }
  return 0;
}
