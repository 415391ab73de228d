#include "common/graphs/submap_filter.hpp"

#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "tests/support/matchers.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix3;
using geometry::Pose2;
using geometry::UncertainPose2;
using slammot::testing::MatrixNear;
using slammot::testing::PoseNear;

UncertainPose2 measured(const Pose2& pose) {
  return {pose, Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal()};
}

/// Trace of the position's covariance [m^2].
double position_variance_m2(const SubmapFilter& filter, std::size_t node) {
  return filter.covariance(node, node).topLeftCorner<2, 2>().trace();
}

/// Four sides of 10 m, back to the start, without the closure.
SubmapFilter around_a_square() {
  SubmapFilter filter;
  filter.add_known({1.0, 2.0, 0.3});
  for (std::size_t side = 0; side < 4; ++side)
    filter.predict(side, measured({10.0, 0.0, std::numbers::pi / 2}));
  return filter;
}

TEST(SubmapFilter, PredictsByCompounding) {
  SubmapFilter filter;
  filter.add_known({1.0, 2.0, 0.3});
  const UncertainPose2 step = measured({5.0, -1.0, 0.4});
  filter.predict(0, step);
  filter.predict(1, step);
  const UncertainPose2 once = geometry::compound({filter.pose(0), Matrix3::Zero()}, step);
  const UncertainPose2 twice = geometry::compound(once, step);
  EXPECT_THAT(filter.pose(2), PoseNear(twice.pose, 1e-12));
  EXPECT_TRUE(filter.covariance(1, 1).isApprox(once.covariance, 1e-12));
  EXPECT_TRUE(filter.covariance(2, 2).isApprox(twice.covariance, 1e-12));
  const Matrix3 cross = geometry::compound_jacobian_first(once.pose, step.pose) * once.covariance;
  EXPECT_TRUE(filter.covariance(2, 1).isApprox(cross, 1e-12));
}

TEST(SubmapFilter, GrowsItsCovarianceUntilTheLoopIsClosedAndShrinksItThen) {
  SubmapFilter filter = around_a_square();
  for (std::size_t node = 1; node < filter.size(); ++node)
    EXPECT_GT(filter.covariance(node, node)(2, 2), filter.covariance(node - 1, node - 1)(2, 2));
  const SubmapFilter before = filter;
  filter.update(0, 4, measured(Pose2::identity()));
  for (std::size_t node = 1; node < filter.size(); ++node) {
    EXPECT_LT(position_variance_m2(filter, node), position_variance_m2(before, node));
    EXPECT_LT(filter.covariance(node, node)(2, 2), before.covariance(node, node)(2, 2));
  }
  EXPECT_LE(position_variance_m2(filter, 4), 0.02 + 1e-9) << "no worse than the closure alone";
  EXPECT_TRUE(filter.covariance(0, 0).isZero()) << "the first submap defines the frame";
}

TEST(SubmapFilter, MeasuresTheInnovationWithBothCovariances) {
  const SubmapFilter filter = around_a_square();
  EXPECT_NEAR(filter.squared_innovation(0, 4, measured(Pose2::identity())), 0.0, 1e-9);
  const double near = filter.squared_innovation(0, 4, measured({0.5, 0.0, 0.0}));
  EXPECT_GT(near, 0.1);
  EXPECT_LT(near, 0.5 * 0.5 / 0.01) << "the state is uncertain, too";
  EXPECT_GT(filter.squared_innovation(0, 4, measured({5.0, 0.0, 0.0})), 50.0);
}

TEST(SubmapFilter, KeepsAMeasurementThatTheStatePredictsWithoutMovingASubmap) {
  SubmapFilter filter = around_a_square();
  const SubmapFilter before = filter;
  filter.update(1, 3, measured(geometry::inverse(before.pose(1)) * before.pose(3)));
  for (std::size_t node = 0; node < filter.size(); ++node)
    EXPECT_THAT(filter.pose(node), PoseNear(before.pose(node), 1e-9));
}

TEST(SubmapFilter, MovesWithTheFirstSubmap) {
  // The same drive, begun elsewhere: the covariances turn with it.
  const Pose2 moved_from_map{300.0, -200.0, 2.0};
  SubmapFilter here;
  SubmapFilter there;
  here.add_known({1.0, 2.0, 0.3});
  there.add_known(moved_from_map * Pose2{1.0, 2.0, 0.3});
  for (SubmapFilter* const filter : {&here, &there}) {
    for (std::size_t side = 0; side < 4; ++side)
      filter->predict(side, measured({10.0, 0.2, std::numbers::pi / 2}));
    filter->update(0, 4, measured({0.3, 0.1, 0.02}));
  }
  Matrix3 turn = Matrix3::Identity();
  turn.topLeftCorner<2, 2>() = geometry::rotation(moved_from_map.heading_rad);
  for (std::size_t node = 0; node < here.size(); ++node) {
    EXPECT_THAT(there.pose(node), PoseNear(moved_from_map * here.pose(node), 1e-9));
    EXPECT_THAT(there.covariance(node, 2),
                MatrixNear(Matrix3(turn * here.covariance(node, 2) * turn.transpose()), 1e-9));
  }
}

TEST(SubmapFilter, KeepsAPositiveCovarianceAfterMeasurementsFarMoreCertainThanThePrediction) {
  SubmapFilter filter;
  filter.add_known({});
  for (std::size_t node = 0; node < 20; ++node) {
    filter.predict(node, {{40.0, 3.0, 0.2}, Eigen::Vector3d(1e6, 1e6, 1.0).asDiagonal()});
    const Pose2 expected = geometry::inverse(filter.pose(0)) * filter.pose(node + 1);
    for (int again = 0; again < 3; ++again)
      filter.update(0, node + 1, {expected, Eigen::Vector3d(1e-6, 1e-6, 1e-8).asDiagonal()});
  }
  for (std::size_t node = 1; node < filter.size(); ++node) {
    const Eigen::SelfAdjointEigenSolver<Matrix3> axes(filter.covariance(node, node));
    EXPECT_GT(axes.eigenvalues().minCoeff(), 1e-9) << "submap " << node;
    EXPECT_LT(filter.covariance(node, node).diagonal().maxCoeff(), 1e-5) << "submap " << node;
  }
}

}  // namespace
}  // namespace slammot::graphs
