#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/uncertain_pose2.hpp"
#include "idl/geometry.h"

/// What the conversions of this folder share; not for use outside.
namespace slammot::wire {

slammot_Pose2 encode(const geometry::Pose2& pose);
slammot_UncertainPose2 encode(const geometry::UncertainPose2& pose);
slammot_Vector2 encode(const Eigen::Vector2d& vector);
slammot_Point2f encode(const Eigen::Vector2f& point);

geometry::Pose2 decode(const slammot_Pose2& pose);
geometry::UncertainPose2 decode(const slammot_UncertainPose2& pose);
Eigen::Vector2d decode(const slammot_Vector2& vector);
Eigen::Vector2f decode(const slammot_Point2f& point);

/// Tolerance of probabilities outside [0, 1] and of negative variances: rounding errors of sums.
inline constexpr double kRounding = 1e-6;

/// Nothing that a vehicle measures in SI units is larger. Sums and squares of larger numbers of a
/// faulty writer could become infinite in an estimator.
inline constexpr double kLargest = 1e12;
inline constexpr double kLargestCovariance = kLargest * kLargest;

/// True if every number is finite, at most kLargest and, for a covariance, variances are not
/// negative.
bool is_sound(double number);
bool is_sound(const slammot_Pose2& pose);
bool is_sound(const slammot_UncertainPose2& pose);
bool is_sound(const slammot_Vector2& vector);
bool is_sound(const slammot_Point2f& point);

/// True if the number is finite, at most kLargest and not negative.
bool is_amount(double number);
/// True if the sweep duration is plausible, with either sign; hours would make tracks diverge.
bool is_sweep(double sweep_s);
bool is_probability(double number);

/// Square matrices travel row by row.
template <int kRows, typename Matrix>
void encode_matrix(const Matrix& matrix, double (&field)[kRows * kRows]) {
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kRows; ++column)
      field[row * kRows + column] = matrix(row, column);
  }
}

template <int kRows>
Eigen::Matrix<double, kRows, kRows> decode_matrix(const double (&field)[kRows * kRows]) {
  return Eigen::Map<const Eigen::Matrix<double, kRows, kRows, Eigen::RowMajor>>(field);
}

template <int kRows>
bool is_covariance(const double (&field)[kRows * kRows]) {
  for (const double number : field) {
    if (!(std::abs(number) <= kLargestCovariance)) return false;  // NaN, too
  }
  for (int i = 0; i < kRows; ++i) {
    if (field[i * (kRows + 1)] < -kRounding) return false;
  }
  return true;
}

/// The elements of a generated sequence.
template <typename Sequence>
auto elements(const Sequence& sequence) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  return std::span<const Element>(sequence._buffer, sequence._length);
}

/// Lets a generated sequence show `buffer`, which keeps its ownership and must outlive the
/// sequence's use.
template <typename Sequence, typename Element>
void show(Sequence& sequence, std::vector<Element>& buffer) {
  const auto size = static_cast<std::uint32_t>(buffer.size());
  sequence = {size, size, buffer.data(), false};
}

/// True if the enumerator is in [0, last]. Writers other than the library may send anything. It
/// reads the bytes by reference, because loading an invalid enumerator is undefined behaviour.
template <typename Enum>
bool is_enumerator(const Enum& value, Enum last) {
  std::underlying_type_t<Enum> number{};
  std::memcpy(&number, &value, sizeof number);
  return std::cmp_greater_equal(number, 0) &&
         std::cmp_less_equal(number, static_cast<std::int64_t>(last));
}

}  // namespace slammot::wire
