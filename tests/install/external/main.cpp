// A small program of another project: a filter, a pose graph and a metric of the installed
// libraries.

#include <cmath>
#include <iostream>

#include "common/filters/imm.hpp"
#include "common/geometry/pose2.hpp"
#include "common/graphs/pose_graph.hpp"
#include "common/metrics/gospa.hpp"

namespace {

using slammot::geometry::Pose2;

/// Position after 10 s of an object that is measured at 2 m/s along x, once a second.
double filtered_x_m() {
  using namespace slammot::filters;
  ModelSet set;
  set.models[0] = {MotionKind::kConstantVelocity, 0.1, 0.5};
  set.models[1] = {MotionKind::kConstantAcceleration, 0.1, 0.5};
  set.size = 2;
  MotionState start;
  start.covariance = Matrix6::Identity() * 100.0;
  ImmState state = imm_start(set, start);
  for (int second = 1; second <= 10; ++second) {
    state = imm_predict(set, state, 1.0);
    state =
        imm_update(set, state, {2.0 * second, 0.0}, 0.01 * Eigen::Matrix2d::Identity()).posterior;
  }
  return imm_combine(set, state).mean.x();
}

/// Position of the second node of a graph that measures it 1 m ahead of the first.
double corrected_x_m() {
  using namespace slammot;
  graphs::PoseGraph graph{graphs::PoseGraphConfig{}};
  graph.add_node({0}, Pose2::identity());
  graph.add_node({1}, Pose2{3.0, 0.5, 0.1});
  flow::Constraint constraint;
  constraint.from = {0};
  constraint.to = {1};
  constraint.from_to = {{1.0, 0.0, 0.0}, 0.01 * Eigen::Matrix3d::Identity()};
  graph.add_constraint(constraint);
  graph.optimise();
  return graph.map_from_node({1}).x_m;
}

double gospa_m() {
  return slammot::metrics::gospa(Eigen::MatrixXd::Constant(1, 1, 3.0), 10.0).distance_m;
}

}  // namespace

int main() {
  std::cout << std::lround(filtered_x_m()) << ' ' << std::lround(corrected_x_m()) << ' '
            << std::lround(gospa_m()) << '\n';
}
