#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/tracking/footprint.hpp"

namespace slammot::tracking {

/// Mean of the echoes on one piece of a body's sides.
struct ContourPoint {
  Eigen::Vector2f in_box_m = Eigen::Vector2f::Zero();
  float weight = 0.0F;      ///< Number of echoes in the mean, up to a limit.
  std::uint8_t piece = 0U;  ///< Place along the sides.
};

/// Contour of a body, accumulated over scans in the frame of its box: origin at the centre, x along
/// the length. One point for each piece of the sides that ever had an echo, counter-clockwise from
/// the right end of the front. Takes the place of the object-grid of Wang 2004, Section 3.4, whose
/// cells off the outline are empty.
struct BodyContour {
  std::vector<ContourPoint> points;  ///< At most kMostContourPoints.
};

/// Of the longest and widest body.
inline constexpr std::size_t kMostContourPoints = 92;

/// Adds the echoes of one scan, in the frame of the footprint's centre. Echoes that lie off the
/// footprint are left out, and points that do are removed. piece_m: length of a piece.
void add_echoes(BodyContour& contour, const Footprint& footprint, const Eigen::Vector2d& centre_m,
                std::span<const Eigen::Vector2d> points_m, double piece_m);

/// The centre of the box is elsewhere on the same body: by_m in the axes of the box.
void recentre(BodyContour& contour, const Eigen::Vector2d& by_m);

/// Front and rear are exchanged.
void turn_about(BodyContour& contour);

/// The points in the frame of the centre, at most as many as given.
void put_contour(const BodyContour& contour, double heading_rad, const Eigen::Vector2d& centre_m,
                 std::size_t most, std::vector<Eigen::Vector2f>& points_m);

}  // namespace slammot::tracking
