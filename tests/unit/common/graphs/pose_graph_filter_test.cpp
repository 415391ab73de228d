#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "common/graphs/pose_graph.hpp"
#include "tests/support/matchers.hpp"

namespace slammot::graphs {
namespace {

using flow::Constraint;
using flow::ConstraintKind;
using flow::SubmapId;
using geometry::Matrix3;
using geometry::Pose2;
using slammot::testing::PoseNear;

constexpr PoseGraphConfig kFilter{.estimator = Estimator::kEkf};

Matrix3 covariance_of(double position_sigma_m, double heading_sigma_rad) {
  return Eigen::Vector3d(position_sigma_m * position_sigma_m, position_sigma_m * position_sigma_m,
                         heading_sigma_rad * heading_sigma_rad)
      .asDiagonal();
}

Constraint constraint_between(std::uint32_t from, std::uint32_t to, const Pose2& from_to,
                              const Matrix3& covariance = covariance_of(0.1, 0.01)) {
  const auto kind = to == from + 1 ? ConstraintKind::kOdometric : ConstraintKind::kLoop;
  return {SubmapId{from}, SubmapId{to}, kind, {from_to, covariance}};
}

Pose2 drawn(const Pose2& truth, const Matrix3& covariance, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d white(normal(random), normal(random), normal(random));
  const Eigen::Vector3d error = Matrix3(covariance.llt().matrixL()) * white;
  return {truth.x_m + error.x(), truth.y_m + error.y(), truth.heading_rad + error.z()};
}

/// Two rounds about a block of 4 x 5 steps of 10 m.
std::vector<Pose2> two_rounds() {
  std::vector<Pose2> truth{Pose2::identity()};
  for (int step = 1; step <= 40; ++step)
    truth.push_back(truth.back() * Pose2{10.0, 0.0, step % 5 == 0 ? std::numbers::pi / 2 : 0.0});
  return truth;
}

/// Adds the nodes from `first` on, at the poses that odometry gives them.
void add_drive(PoseGraph& graph, const std::vector<Constraint>& odometry, std::uint32_t first = 0) {
  Pose2 pose;
  graph.add_node(SubmapId{first}, pose);
  for (const Constraint& step : odometry) {
    if (step.from.value < first) continue;
    pose = pose * step.from_to.pose;
    graph.add_node(step.to, pose);
    graph.add_constraint(step);
  }
}

std::vector<Constraint> odometry_of(const std::vector<Pose2>& truth, std::mt19937_64& random,
                                    double heading_sigma_rad = 0.01) {
  std::vector<Constraint> odometry;
  for (std::uint32_t i = 1; i < truth.size(); ++i) {
    odometry.push_back(constraint_between(i - 1, i, inverse(truth[i - 1]) * truth[i],
                                          covariance_of(0.1, heading_sigma_rad)));
    odometry.back().from_to.pose =
        drawn(odometry.back().from_to.pose, odometry.back().from_to.covariance, random);
  }
  return odometry;
}

Constraint drawn_closure(const std::vector<Pose2>& truth, std::uint32_t from, std::uint32_t to,
                         std::mt19937_64& random) {
  Constraint closure = constraint_between(from, to, inverse(truth[from]) * truth[to]);
  closure.from_to.pose = drawn(closure.from_to.pose, closure.from_to.covariance, random);
  return closure;
}

/// Drawn measurements of the two rounds, closed at each side of the second one.
PoseGraph closed(const PoseGraphConfig& config, std::uint64_t seed,
                 double heading_sigma_rad = 0.01) {
  const auto truth = two_rounds();
  std::mt19937_64 random(seed);
  PoseGraph graph(config);
  add_drive(graph, odometry_of(truth, random, heading_sigma_rad));
  for (const std::uint32_t to : {20U, 25U, 30U, 35U, 40U})
    graph.add_constraint(drawn_closure(truth, to - 20, to, random));
  graph.optimise();
  return graph;
}

/// Mean over the nodes but the first of the squared error by its covariance, 3 degrees of freedom.
double mean_nees(const PoseGraph& graph, const std::vector<Pose2>& truth) {
  const auto covariances = graph.covariances();
  double sum = 0.0;
  for (std::uint32_t i = 1; i < truth.size(); ++i) {
    const Eigen::Vector3d error = geometry::difference(graph.map_from_node(SubmapId{i}), truth[i]);
    sum += error.dot(covariances.at(SubmapId{i}).ldlt().solve(error));
  }
  return sum / static_cast<double>(truth.size() - 1);
}

TEST(PoseGraphFilter, EqualsLeastSquaresInTheLinearCase) {
  // With headings known to a microradian, relative poses are linear in the positions.
  const Matrix3 covariance = covariance_of(0.1, 1e-6);
  std::mt19937_64 random(3);
  PoseGraph filter(kFilter);
  PoseGraph least_squares({});
  for (PoseGraph* const graph : {&filter, &least_squares}) {
    random.seed(3);
    Pose2 pose;
    graph->add_node(SubmapId{0}, pose);
    for (std::uint32_t i = 1; i <= 12; ++i) {
      Pose2 step = drawn({10.0, 0.0, 0.0}, covariance, random);
      step.heading_rad = 0.0;
      pose = pose * step;
      graph->add_node(SubmapId{i}, pose);
      graph->add_constraint(constraint_between(i - 1, i, step, covariance));
    }
    graph->add_constraint(constraint_between(0, 12, {120.3, 0.2, 0.0}, covariance));
    graph->add_constraint(constraint_between(3, 9, {60.2, -0.1, 0.0}, covariance));
    graph->optimise();
  }
  const auto covariance_of_filter = filter.covariances();
  const auto covariance_of_least_squares = least_squares.covariances();
  for (std::uint32_t i = 1; i <= 12; ++i) {
    EXPECT_THAT(filter.map_from_node(SubmapId{i}),
                PoseNear(least_squares.map_from_node(SubmapId{i}), 1e-5));
    EXPECT_TRUE(covariance_of_filter.at(SubmapId{i})
                    .isApprox(covariance_of_least_squares.at(SubmapId{i}), 1e-3));
  }
}

/// Mean over drives; nodes of one drive share most of their error.
double mean_nees(const PoseGraphConfig& config, int drives, double heading_sigma_rad) {
  double sum = 0.0;
  for (int seed = 1; seed <= drives; ++seed)
    sum += mean_nees(closed(config, static_cast<std::uint64_t>(seed), heading_sigma_rad),
                     two_rounds());
  return sum / drives;
}

/// Three sigmas of the mean of independent draws with 3 degrees of freedom.
double nees_band(int draws) { return 3.0 * std::sqrt(6.0 / draws); }

TEST(PoseGraphFilter, IsConsistentOnASimulatedLoop) {
  constexpr int kDrives = 60;
  EXPECT_NEAR(mean_nees(kFilter, kDrives, 0.01), 3.0, nees_band(kDrives));
  EXPECT_NEAR(mean_nees({}, kDrives, 0.01), 3.0, nees_band(kDrives));
}

TEST(PoseGraphFilter, StaysConsistentWhereHeadingsAreUncertain) {
  // 0.02 rad a submap, 0.09 rad when the first loop is closed. With (x, y, heading) as errors in
  // place of twists the mean is above 5.
  constexpr int kDrives = 60;
  EXPECT_NEAR(mean_nees(kFilter, kDrives, 0.02), 3.0, nees_band(kDrives));
}

TEST(PoseGraphFilter, GivesTheSamePosesWhetherClosuresArriveTogetherOrOneByOne) {
  const auto truth = two_rounds();
  std::mt19937_64 random(5);
  PoseGraph graph(kFilter);
  add_drive(graph, odometry_of(truth, random));
  for (const std::uint32_t to : {20U, 25U, 30U, 35U, 40U}) {
    graph.add_constraint(drawn_closure(truth, to - 20, to, random));
    graph.optimise();
  }
  const PoseGraph at_once = closed(kFilter, 5);
  for (const auto& node : graph.nodes())
    EXPECT_THAT(node.map_from_submap, PoseNear(at_once.map_from_node(node.submap_id), 1e-12));
}

TEST(PoseGraphFilter, RefusesAFalseLoop) {
  PoseGraph graph = closed(kFilter, 7);
  const auto before = graph.nodes();
  graph.add_constraint(constraint_between(2, 38, {40.0, 0.0, 0.0}));
  graph.optimise();
  EXPECT_EQ(graph.weight(graph.constraints().size() - 1), 0.0);
  for (const auto& node : before)
    EXPECT_THAT(graph.map_from_node(node.submap_id), PoseNear(node.map_from_submap, 1e-12));
}

TEST(PoseGraphFilter, ForgetsALoopThatIsDisabledLater) {
  const PoseGraph without = closed(kFilter, 9);
  PoseGraph graph = closed(kFilter, 9);
  const auto truth = two_rounds();
  graph.add_constraint(constraint_between(3, 23, Pose2{0.1, 0.1, 0.01}));
  graph.optimise();
  ASSERT_EQ(graph.weight(graph.constraints().size() - 1), 1.0);
  graph.set_enabled(graph.constraints().size() - 1, false);
  graph.optimise();
  for (const auto& node : without.nodes())
    EXPECT_THAT(graph.map_from_node(node.submap_id), PoseNear(node.map_from_submap, 1e-9));
}

TEST(PoseGraphFilter, JoinsAnIslandByTheLoopThatTiesIt) {
  // Nodes 0 to 19 and, without a constraint between, 21 to 40.
  const auto truth = two_rounds();
  std::vector<Constraint> odometry;
  for (std::uint32_t i = 1; i < truth.size(); ++i)
    odometry.push_back(constraint_between(i - 1, i, inverse(truth[i - 1]) * truth[i]));
  PoseGraph graph(kFilter);
  add_drive(graph, {odometry.begin(), odometry.begin() + 19});
  add_drive(graph, odometry, 21);
  graph.optimise();
  EXPECT_THAT(graph.map_from_node(SubmapId{21}), PoseNear(Pose2::identity(), 1e-12));
  graph.add_constraint(constraint_between(10, 30, Pose2::identity()));
  graph.move_node(SubmapId{21}, truth[21]);  // as loop closing moves an island
  graph.optimise();
  for (std::uint32_t i = 21; i < truth.size(); ++i)
    EXPECT_THAT(graph.map_from_node(SubmapId{i}), PoseNear(truth[i], 1e-9));
  const auto covariances = graph.covariances();
  EXPECT_GT(covariances.at(SubmapId{40})(2, 2), covariances.at(SubmapId{30})(2, 2));
}

}  // namespace
}  // namespace slammot::graphs
