#include "common/wire/parts.hpp"

namespace slammot::wire {

slammot_Pose2 encode(const geometry::Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }

slammot_UncertainPose2 encode(const geometry::UncertainPose2& pose) {
  slammot_UncertainPose2 sample{encode(pose.pose), {}};
  encode_matrix<3>(pose.covariance, sample.covariance);
  return sample;
}

slammot_Vector2 encode(const Eigen::Vector2d& vector) { return {vector.x(), vector.y()}; }
slammot_Point2f encode(const Eigen::Vector2f& point) { return {point.x(), point.y()}; }

geometry::Pose2 decode(const slammot_Pose2& pose) { return {pose.x_m, pose.y_m, pose.heading_rad}; }

geometry::UncertainPose2 decode(const slammot_UncertainPose2& pose) {
  return {decode(pose.mean), decode_matrix<3>(pose.covariance)};
}

Eigen::Vector2d decode(const slammot_Vector2& vector) { return {vector.x, vector.y}; }
Eigen::Vector2f decode(const slammot_Point2f& point) { return {point.x_m, point.y_m}; }

bool is_sound(double number) { return std::abs(number) <= kLargest; }  // false for NaN

bool is_sound(const slammot_Pose2& pose) {
  return is_sound(pose.x_m) && is_sound(pose.y_m) && is_sound(pose.heading_rad);
}

bool is_sound(const slammot_UncertainPose2& pose) {
  return is_sound(pose.mean) && is_covariance<3>(pose.covariance);
}
bool is_sound(const slammot_Vector2& vector) { return is_sound(vector.x) && is_sound(vector.y); }
bool is_sound(const slammot_Point2f& point) {
  return std::isfinite(point.x_m) && std::isfinite(point.y_m);
}
bool is_amount(double number) { return number >= 0.0 && number <= kLargest; }
bool is_sweep(double sweep_s) {
  constexpr double kLongestS = 10.0;
  return std::abs(sweep_s) <= kLongestS;  // false for NaN
}
bool is_probability(double number) { return number >= -kRounding && number <= 1.0 + kRounding; }

}  // namespace slammot::wire
