#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace slammot::tracking {

/// What the scan shows beside the outermost echo of an object, away from the object.
enum class Edge : std::uint8_t {
  kOpen,    ///< A more distant echo: the object ends here.
  kNoEcho,  ///< No echo: the object ends here or goes on without answering.
  kHidden,  ///< A nearer echo, or the end of the field of view.
};

/// A straight side of an object.
struct Side {
  double heading_rad = 0.0;  ///< In odom; the sense along the side is unknown.
  double length_m = 0.0;     ///< Of the visible part.
  double off_m = 0.0;  ///< Mean distance of the echoes from the sides of the fitted box; large for
                       ///< round objects.
};

/// The echoes of one object in one scan, in odom.
struct Observation {
  std::span<const Eigen::Vector2d> points_m;  ///< In the order of the beams; at least one.
  Eigen::Vector2d laser_m = Eigen::Vector2d::Zero();
  double beam_step_rad = 0.0;     ///< Positive.
  Edge start = Edge::kOpen;       ///< Before the first point.
  Edge end = Edge::kOpen;         ///< After the last point.
  std::optional<Side> side;       ///< A long straight side, if one is visible.
  double unanswered_share = 0.0;  ///< Share of the beams on the object without an echo: high for
                                  ///< dark surfaces.
};

/// Largest extent of the points along four fixed axes [m]: a lower bound of their diameter, exact
/// to 8 %.
double largest_span_m(std::span<const Eigen::Vector2d> points_m);

/// Mean number of consecutive beams without an echo.
double mean_gap(const Observation& observation);

}  // namespace slammot::tracking
