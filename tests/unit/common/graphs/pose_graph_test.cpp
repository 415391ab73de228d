#include "common/graphs/pose_graph.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "common/graphs/path_uncertainty.hpp"
#include "tests/support/g2o_graph.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::graphs {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using slammot::testing::PoseNear;

Matrix3 covariance_of(double position_sigma_m, double heading_sigma_rad) {
  return Eigen::Vector3d(position_sigma_m * position_sigma_m, position_sigma_m * position_sigma_m,
                         heading_sigma_rad * heading_sigma_rad)
      .asDiagonal();
}

Constraint constraint_between(std::uint32_t from, std::uint32_t to, ConstraintKind kind,
                              const Pose2& from_to) {
  return {SubmapId{from}, SubmapId{to}, kind, {from_to, covariance_of(0.1, 0.02)}};
}

/// Drives a square of 4 x 10 m and comes back to its start.
std::vector<Pose2> square_drive(int nodes_per_side) {
  std::vector<Pose2> poses;
  Pose2 pose;
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < nodes_per_side; ++i) {
      poses.push_back(pose);
      pose = pose * Pose2{10.0 / nodes_per_side, 0.0,
                          i + 1 == nodes_per_side ? std::numbers::pi / 2 : 0.0};
    }
  }
  poses.push_back(pose);
  return poses;
}

/// The chain of the drive as bent odometry sees it: every step turns a little too far.
PoseGraph bent_chain(const std::vector<Pose2>& truth, double bend_rad) {
  PoseGraph graph({});
  Pose2 pose = truth.front();
  graph.add_node(SubmapId{0}, pose);
  for (std::uint32_t i = 1; i < truth.size(); ++i) {
    const Pose2 step = inverse(truth[i - 1]) * truth[i] * Pose2{0.0, 0.0, bend_rad};
    pose = pose * step;
    graph.add_node(SubmapId{i}, pose);
    graph.add_constraint(constraint_between(i - 1, i, ConstraintKind::kOdometric, step));
  }
  return graph;
}

double largest_position_error_m(const PoseGraph& graph, const std::vector<Pose2>& truth) {
  double largest = 0.0;
  for (std::uint32_t i = 0; i < truth.size(); ++i) {
    largest = std::max(
        largest,
        (graph.map_from_node(SubmapId{i}).translation_m() - truth[i].translation_m()).norm());
  }
  return largest;
}

TEST(PoseGraph, LeavesAChainWithoutLoopsWhereItIs) {
  PoseGraph graph = bent_chain(square_drive(5), 0.02);
  const auto before = graph.nodes();
  EXPECT_NEAR(graph.optimise().final_cost, 0.0, 1e-12);
  for (const auto& node : before)
    EXPECT_THAT(graph.map_from_node(node.submap_id), PoseNear(node.map_from_submap, 1e-9));
}

TEST(PoseGraph, ClosesASquareAndKeepsItsFirstNode) {
  const auto truth = square_drive(5);
  PoseGraph graph = bent_chain(truth, 0.02);
  EXPECT_GT(largest_position_error_m(graph, truth), 2.0);
  graph.add_constraint(constraint_between(0, 20, ConstraintKind::kLoop, Pose2::identity()));
  EXPECT_TRUE(graph.optimise().has_converged);
  EXPECT_LT(largest_position_error_m(graph, truth), 0.5);
  EXPECT_EQ(graph.map_from_node(SubmapId{0}), truth.front());
}

TEST(PoseGraph, SpreadsTheErrorOfALoopEvenlyOverEqualSteps) {
  PoseGraph graph({});
  const Pose2 step{1.0, 0.0, 0.0};
  for (std::uint32_t i = 0; i < 5; ++i) graph.add_node(SubmapId{i}, {1.0 * i, 0.0, 0.0});
  for (std::uint32_t i = 1; i < 5; ++i)
    graph.add_constraint(constraint_between(i - 1, i, ConstraintKind::kOdometric, step));
  graph.add_constraint(constraint_between(0, 4, ConstraintKind::kOdometric, {4.5, 0.0, 0.0}));
  graph.optimise();
  for (std::uint32_t i = 0; i < 5; ++i)
    EXPECT_NEAR(graph.map_from_node(SubmapId{i}).x_m, 1.1 * i, 1e-6);
}

TEST(PoseGraph, HoldsOutAgainstOneFalseLoopAmongRightOnes) {
  const auto truth = square_drive(5);
  PoseGraph graph = bent_chain(truth, 0.01);
  for (const std::uint32_t back : {0U, 1U, 2U}) {
    graph.add_constraint(
        constraint_between(back, 20, ConstraintKind::kLoop, inverse(truth[back]) * truth[20]));
  }
  graph.add_constraint(constraint_between(5, 15, ConstraintKind::kLoop, Pose2::identity()));
  graph.optimise();
  EXPECT_LT(largest_position_error_m(graph, truth), 0.5);
}

TEST(PoseGraph, TakesTheWeightOfAFalseLoopOnceRightOnesContradictIt) {
  const auto truth = square_drive(5);
  PoseGraph graph = bent_chain(truth, 0.01);
  const std::size_t odometric = graph.constraints().size();
  // 4 m off, in reach of the odometry
  graph.add_constraint(constraint_between(2, 20, ConstraintKind::kLoop, Pose2::identity()));
  graph.optimise();
  EXPECT_GT(graph.weight(odometric), 0.5);
  EXPECT_GT(largest_position_error_m(graph, truth), 2.0);
  for (const std::uint32_t back : {0U, 1U}) {
    graph.add_constraint(
        constraint_between(back, 20, ConstraintKind::kLoop, inverse(truth[back]) * truth[20]));
  }
  graph.optimise();
  EXPECT_LT(graph.weight(odometric), 0.5);
  EXPECT_GT(graph.weight(odometric + 1), 0.5);
  EXPECT_LT(largest_position_error_m(graph, truth), 0.5);
}

TEST(PoseGraph, LeavesOutWhatIsNotEnabled) {
  const auto truth = square_drive(5);
  PoseGraph graph = bent_chain(truth, 0.02);
  const std::size_t loop = graph.constraints().size();
  graph.add_constraint(constraint_between(0, 20, ConstraintKind::kLoop, Pose2::identity()));
  graph.set_enabled(loop, false);
  graph.optimise();
  EXPECT_GT(largest_position_error_m(graph, truth), 2.0);
  graph.set_enabled(loop, true);
  graph.optimise();
  EXPECT_LT(largest_position_error_m(graph, truth), 0.5);
}

TEST(BestPath, TakesALoopThatIsSurerThanTheChain) {
  const PoseGraph graph = bent_chain(square_drive(5), 0.0);
  std::vector<Constraint> constraints = graph.constraints();
  const std::size_t loop = constraints.size();
  constraints.push_back(constraint_between(0, 20, ConstraintKind::kLoop, Pose2::identity()));
  EXPECT_EQ(best_path(SubmapId{19}, SubmapId{1}, constraints),
            (std::vector<std::size_t>{0, loop, loop - 1}));
  EXPECT_TRUE(best_path(SubmapId{0}, SubmapId{99}, constraints).empty());
}

TEST(PoseGraph, MovesItsAnswerWithItsFirstNode) {
  const auto truth = square_drive(4);
  const Pose2 moved_from_map{50.0, -20.0, 2.5};
  PoseGraph graph({});
  PoseGraph moved({});
  PoseGraph bent = bent_chain(truth, 0.02);
  for (const auto& node : bent.nodes()) {
    graph.add_node(node.submap_id, node.map_from_submap);
    moved.add_node(node.submap_id, moved_from_map * node.map_from_submap);
  }
  std::vector<Constraint> constraints = bent.constraints();
  constraints.push_back(constraint_between(0, 16, ConstraintKind::kLoop, Pose2::identity()));
  for (const Constraint& constraint : constraints) {
    graph.add_constraint(constraint);
    moved.add_constraint(constraint);
  }
  graph.optimise();
  moved.optimise();
  for (const auto& node : graph.nodes()) {
    EXPECT_THAT(moved.map_from_node(node.submap_id),
                PoseNear(moved_from_map * node.map_from_submap, 1e-4));
  }
}

TEST(PoseGraph, GivesTheSameBitsTwice) {
  const auto run = [] {
    PoseGraph graph = bent_chain(square_drive(6), 0.013);
    graph.add_constraint(constraint_between(0, 24, ConstraintKind::kLoop, {0.1, 0.02, 0.01}));
    graph.optimise();
    return graph.nodes();
  };
  const auto first = run();
  const auto second = run();
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(first[i].map_from_submap, second[i].map_from_submap);
}

TEST(SquaredError, CountsSigmas) {
  const Constraint constraint = constraint_between(0, 1, ConstraintKind::kLoop, {2.0, 0.0, 0.0});
  EXPECT_NEAR(squared_error(constraint, {5.0, 5.0, 0.0}, {7.3, 5.0, 0.04}), 9.0 + 4.0, 1e-9);
}

/// Weights of the isotropic chordal cost (Rosen et al., SE-Sync, IJRR 2019, Eqs. (10)-(11)): sum
/// over the constraints of tau |dt|^2 + kappa |dR|_F^2.
struct IsotropicWeights {
  double tau = 0.0;
  double kappa = 0.0;
};

IsotropicWeights isotropic_weights(const Matrix3& covariance) {
  const Matrix3 information = covariance.inverse();
  return {2.0 / information.topLeftCorner<2, 2>().inverse().trace(), information(2, 2)};
}

double chordal_cost(const PoseGraph& graph, const std::vector<Constraint>& constraints) {
  double cost = 0.0;
  for (const Constraint& constraint : constraints) {
    const IsotropicWeights weights = isotropic_weights(constraint.from_to.covariance);
    const Pose2 from_to =
        inverse(graph.map_from_node(constraint.from)) * graph.map_from_node(constraint.to);
    const Pose2& measured = constraint.from_to.pose;
    cost += weights.tau * (from_to.translation_m() - measured.translation_m()).squaredNorm() +
            weights.kappa * 4.0 * (1.0 - std::cos(from_to.heading_rad - measured.heading_rad));
  }
  return cost;
}

/// Optimises a published graph from poses chained along its constraints; the weights are those of
/// the chordal cost.
double optimised_chordal_cost(const slammot::testing::G2oGraph& published) {
  PoseGraph graph({.max_iterations = 200});
  std::vector<Constraint> isotropic = published.constraints;
  for (Constraint& constraint : isotropic) {
    const IsotropicWeights weights = isotropic_weights(constraint.from_to.covariance);
    constraint.from_to.covariance =
        Eigen::Vector3d(1.0 / weights.tau, 1.0 / weights.tau, 0.5 / weights.kappa).asDiagonal();
  }
  const auto chained = poses_along_best_paths(published.constraints.front().from, isotropic);
  for (const auto& [id, root_from_node] : chained) graph.add_node(id, root_from_node.pose);
  for (const Constraint& constraint : isotropic) graph.add_constraint(constraint);
  graph.optimise();
  return chordal_cost(graph, published.constraints);
}

struct KnownOptimum {
  const char* file;
  double chordal_cost;
};

/// Names the test.
void PrintTo(const KnownOptimum& known, std::ostream* to) { *to << known.file; }

class PublishedGraph : public ::testing::TestWithParam<KnownOptimum> {};

TEST_P(PublishedGraph, ReachesTheCertifiedOptimum) {
  const auto [file, optimum] = GetParam();
  const std::string text = slammot::testing::read_text(std::filesystem::path(SLAMMOT_SHARED_DATA) /
                                                       "pose_graphs" / file);
  if (text.empty()) GTEST_SKIP() << "../shared/data/pose_graphs/" << file << " is not here";
  EXPECT_NEAR(optimised_chordal_cost(slammot::testing::parse_g2o(text)), optimum, 0.01 * optimum);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedGraph,
                         ::testing::Values(KnownOptimum{"manhattan.g2o.gz", 6.432e3},
                                           KnownOptimum{"intel.g2o.gz", 5.235e1}));

}  // namespace
}  // namespace slammot::graphs
