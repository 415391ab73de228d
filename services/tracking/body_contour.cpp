#include "services/tracking/body_contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;

constexpr int kOfFace = 8;    ///< Pieces of a face, of the widest body,
constexpr int kOfFlank = 38;  ///< and of a flank, of the longest.
static_assert(2 * (kOfFace + kOfFlank) == kMostContourPoints);

constexpr float kMostWeight = 20.0F;  ///< Then the mean is a running one: a box is corrected while
                                      ///< it is followed.

/// Half the sides of a box, and what is still on it.
struct Sides {
  Vector2f half_m;
  float piece_m;

  /// Depth below the nearer side; negative outside.
  Vector2f depth_m(const Vector2f& at_m) const { return half_m - at_m.cwiseAbs(); }

  bool has(const Vector2f& at_m) const { return depth_m(at_m).minCoeff() > -piece_m; }

  /// Along the sides, counter-clockwise from the right end of the front.
  std::uint8_t piece_at(const Vector2f& at_m) const {
    const Vector2f depth = depth_m(at_m);
    const bool is_on_face = depth.x() < depth.y();
    const auto piece_of = [&](float along_m, int pieces) {
      return std::clamp(static_cast<int>(std::floor(along_m / piece_m)) + pieces / 2, 0,
                        pieces - 1);
    };
    int piece = 0;
    if (is_on_face && at_m.x() >= 0.0F) piece = piece_of(at_m.y(), kOfFace);
    else if (is_on_face) piece = kOfFace + kOfFlank + piece_of(-at_m.y(), kOfFace);
    else if (at_m.y() >= 0.0F) piece = kOfFace + piece_of(-at_m.x(), kOfFlank);
    else piece = 2 * kOfFace + kOfFlank + piece_of(at_m.x(), kOfFlank);
    return static_cast<std::uint8_t>(piece);
  }
};

/// Mean of both, with the second's piece.
ContourPoint joined(const ContourPoint& a, const ContourPoint& b) {
  const float weight = a.weight + b.weight;
  return {(a.weight * a.in_box_m + b.weight * b.in_box_m) / weight, std::min(weight, kMostWeight),
          b.piece};
}

/// Orders the points along the sides as they are now, and joins those of one piece.
void order(std::vector<ContourPoint>& points, const Sides& sides) {
  std::erase_if(points, [&](const ContourPoint& point) { return !sides.has(point.in_box_m); });
  for (ContourPoint& point : points) point.piece = sides.piece_at(point.in_box_m);
  std::ranges::sort(points, {}, &ContourPoint::piece);
  std::size_t kept = 0;
  for (const ContourPoint& point : points) {
    if (kept > 0 && points[kept - 1].piece == point.piece)
      points[kept - 1] = joined(points[kept - 1], point);
    else points[kept++] = point;
  }
  points.resize(kept);
}

}  // namespace

void add_echoes(BodyContour& contour, const Footprint& footprint, const Vector2d& centre_m,
                std::span<const Vector2d> points_m, double piece_m) {
  std::vector<ContourPoint>& points = contour.points;
  const Sides sides{{static_cast<float>(0.5 * footprint.length.value_m),
                     static_cast<float>(0.5 * footprint.width.value_m)},
                    static_cast<float>(piece_m)};
  order(points, sides);
  std::array<ContourPoint, kMostContourPoints> seen{};
  const Eigen::Matrix2d box_from_odom =
      Eigen::Rotation2Dd(-footprint.heading_rad).toRotationMatrix();
  for (const Vector2d& point_m : points_m) {
    const Vector2f at_m = (box_from_odom * (point_m - centre_m)).cast<float>();
    if (!sides.has(at_m)) continue;
    const std::uint8_t piece = sides.piece_at(at_m);
    seen[piece] = joined(seen[piece], {at_m, 1.0F, piece});
  }
  for (ContourPoint& point : points) {
    ContourPoint& now = seen[point.piece];
    if (now.weight > 0.0F) point = joined(point, now);
    now.weight = 0.0F;
  }
  points.reserve(kMostContourPoints);
  for (const ContourPoint& point : seen)
    if (point.weight > 0.0F) points.push_back(point);
  std::ranges::sort(points, {}, &ContourPoint::piece);
}

void recentre(BodyContour& contour, const Vector2d& by_m) {
  for (ContourPoint& point : contour.points) point.in_box_m -= by_m.cast<float>();
}

void turn_about(BodyContour& contour) {
  for (ContourPoint& point : contour.points) point.in_box_m = -point.in_box_m;
}

void put_contour(const BodyContour& contour, double heading_rad, const Vector2d& centre_m,
                 std::size_t most, std::vector<Vector2f>& points_m) {
  const Eigen::Matrix2d odom_from_box = Eigen::Rotation2Dd(heading_rad).toRotationMatrix();
  const std::size_t count = std::min(most, contour.points.size());
  points_m.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const ContourPoint& point = contour.points[i * contour.points.size() / count];
    points_m.emplace_back((centre_m + odom_from_box * point.in_box_m.cast<double>()).cast<float>());
  }
}

}  // namespace slammot::tracking
