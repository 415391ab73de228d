#include "common/geometry/unscented.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::geometry::unscented {
namespace {

constexpr double kFourthMoment = 3.0;  // of a Gaussian: spreads the points so that this much is
                                       // right too; Julier 1999

/// Lower Cholesky factor of a positive semidefinite matrix; what is known exactly gives a column of
/// zeros.
template <int N>
Eigen::Matrix<double, N, N> square_root(const Eigen::Matrix<double, N, N>& covariance) {
  Eigen::Matrix<double, N, N> root = Eigen::Matrix<double, N, N>::Zero();
  for (int column = 0; column < N; ++column) {
    const double pivot = covariance(column, column) - root.row(column).head(column).squaredNorm();
    if (pivot <= 1e-12 * covariance(column, column)) continue;
    root(column, column) = std::sqrt(pivot);
    for (int row = column + 1; row < N; ++row) {
      root(row, column) = (covariance(row, column) -
                           root.row(row).head(column).dot(root.row(column).head(column))) /
                          root(column, column);
    }
  }
  return root;
}

/// Mean and covariance of pose_of(error), error a Gaussian about 0 in N dimensions. Only the first
/// may be one in which pose_of bends: its error is then in one column of the root, and the weights,
/// of which the middle one is negative for more than three dimensions, leave the covariance
/// positive.
template <int N, typename PoseOf>
UncertainPose2 transform(const Eigen::Matrix<double, N, N>& covariance, PoseOf pose_of) {
  const Eigen::Matrix<double, N, N> root = std::sqrt(kFourthMoment) * square_root<N>(covariance);
  const Pose2 middle = pose_of(Eigen::Matrix<double, N, 1>::Zero());
  constexpr double kWeight = 0.5 / kFourthMoment;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Matrix3 spread = Matrix3::Zero();
  for (int column = 0; column < N; ++column) {
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d away = difference(pose_of(side * root.col(column)), middle);
      shift += kWeight * away;
      spread += kWeight * away * away.transpose();
    }
  }
  return {
      {middle.x_m + shift.x(), middle.y_m + shift.y(), wrap_angle(middle.heading_rad + shift.z())},
      spread - shift * shift.transpose()};
}

// Heading first: the dimension in which poses bend.
const Matrix3 kHeadingFirst{{0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};

template <typename Error>
Pose2 moved_by_error(const Pose2& pose, const Error& heading_first) {
  return {pose.x_m + heading_first[1], pose.y_m + heading_first[2],
          pose.heading_rad + heading_first[0]};
}

template <typename Operation>
UncertainPose2 of_two(const UncertainPose2& first, const UncertainPose2& second,
                      const Matrix3& cross, Operation operation) {
  Eigen::Matrix<double, 6, 6> joint;
  joint.topLeftCorner<3, 3>() = kHeadingFirst * first.covariance * kHeadingFirst.transpose();
  joint.topRightCorner<3, 3>() = kHeadingFirst * cross * kHeadingFirst.transpose();
  joint.bottomLeftCorner<3, 3>() = joint.topRightCorner<3, 3>().transpose();
  joint.bottomRightCorner<3, 3>() = kHeadingFirst * second.covariance * kHeadingFirst.transpose();
  return transform<6>(joint, [&](const Eigen::Matrix<double, 6, 1>& error) {
    return operation(moved_by_error(first.pose, error.head<3>()),
                     moved_by_error(second.pose, error.tail<3>()));
  });
}

}  // namespace

UncertainPose2 compound(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                        const Matrix3& cross) {
  return of_two(a_from_b, b_from_c, cross,
                [](const Pose2& ab, const Pose2& bc) { return ab * bc; });
}

double linearization_error(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                           const Matrix3& cross) {
  const Vector2 lever_in_a = rotation(a_from_b.pose.heading_rad) * b_from_c.pose.translation_m();
  const double lever_m = lever_in_a.norm();
  const double bend_m = 0.5 * lever_m * a_from_b.covariance(2, 2);
  if (bend_m <= 0.0) return 0.0;
  const Vector2 along = lever_in_a / lever_m;
  const Vector2 across{-along.y(), along.x()};
  const Eigen::Matrix2d position =
      geometry::compound(a_from_b, b_from_c, cross).covariance.topLeftCorner<2, 2>();
  return std::max(bend_m / std::sqrt(std::max(along.dot(position * along), 0.0)),
                  2.0 * bend_m / std::sqrt(std::max(across.dot(position * across), 0.0)));
}

UncertainPose2 compound_as_needed(const UncertainPose2& a_from_b, const UncertainPose2& b_from_c,
                                  const Matrix3& cross) {
  return linearization_error(a_from_b, b_from_c, cross) > kLargestLinearizationError
             ? unscented::compound(a_from_b, b_from_c, cross)
             : geometry::compound(a_from_b, b_from_c, cross);
}

UncertainPose2 inverse(const UncertainPose2& a_from_b) {
  return transform<3>(kHeadingFirst * a_from_b.covariance * kHeadingFirst.transpose(),
                      [&](const Eigen::Vector3d& error) {
                        return geometry::inverse(moved_by_error(a_from_b.pose, error));
                      });
}

UncertainPose2 tail_to_tail(const UncertainPose2& a_from_b, const UncertainPose2& a_from_c,
                            const Matrix3& cross) {
  return of_two(a_from_b, a_from_c, cross,
                [](const Pose2& ab, const Pose2& ac) { return geometry::inverse(ab) * ac; });
}

}  // namespace slammot::geometry::unscented
