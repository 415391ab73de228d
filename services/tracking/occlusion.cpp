#include "services/tracking/occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>

#include "services/tracking/published_covariance.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

/// Distances at which a ray enters and leaves a footprint.
struct Chord {
  double entry_m = 0.0;
  double exit_m = 0.0;
};

/// Intersection of a ray with the rectangle (slabs); none where the ray misses it.
std::optional<Chord> chord_of(const Footprint& footprint, const Vector2d& from_m,
                              const Vector2d& direction) {
  const Vector2d along(std::cos(footprint.heading_rad), std::sin(footprint.heading_rad));
  const Vector2d across(-along.y(), along.x());
  Chord chord{0.0, 1e9};
  const std::array<std::pair<Vector2d, double>, 2> slabs = {
      {{along, 0.5 * footprint.length.value_m}, {across, 0.5 * footprint.width.value_m}}};
  for (const auto& [axis, half_m] : slabs) {
    const double slope = axis.dot(direction);
    const double offset_m = axis.dot(from_m);
    if (std::abs(slope) < 1e-9) {
      if (std::abs(offset_m) > half_m) return std::nullopt;
      continue;
    }
    const double a = (-half_m - offset_m) / slope;
    const double b = (half_m - offset_m) / slope;
    chord.entry_m = std::max(chord.entry_m, std::min(a, b));
    chord.exit_m = std::min(chord.exit_m, std::max(a, b));
  }
  return chord.entry_m <= chord.exit_m ? std::optional(chord) : std::nullopt;
}

struct BeamCounts {
  int beams = 0;
  int visible = 0;
  int passed = 0;
};

BeamCounts count_beams(const Footprint& footprint, const Vector2d& centre_m, double margin_m,
                       const ScanView& view) {
  const ScanView::Directions directions = view.directions_of(footprint, centre_m, 0.0);
  const double step_rad = view.beam_step_rad() * (view.scan().beam_step_rad < 0.0 ? -1.0 : 1.0);
  const Vector2d to_centre_m = centre_m - view.laser_in_odom_m();
  const double middle_rad = std::atan2(to_centre_m.y(), to_centre_m.x());
  const double middle = view.polar().steps_towards(middle_rad);
  BeamCounts counts;
  for (std::size_t i = 0; i < directions.count; ++i) {
    const std::size_t beam = *view.polar().neighbour_of(directions.first, static_cast<long>(i));
    const double direction_rad = middle_rad + (static_cast<double>(beam) - middle) * step_rad;
    const std::optional<Chord> chord =
        chord_of(footprint, -to_centre_m, {std::cos(direction_rad), std::sin(direction_rad)});
    if (!chord) continue;
    const double range_m = view.polar().range_m(beam);
    ++counts.beams;
    counts.visible += range_m <= 0.0 || range_m > chord->entry_m - margin_m ? 1 : 0;
    counts.passed += range_m > chord->exit_m + margin_m ? 1 : 0;
  }
  return counts;
}

/// True if echoes at the predicted place may as well be another object's: of a pedestrian, beside
/// whom others are, and of a vehicle whose position has a sigma of more than a car's length.
bool is_place_forgotten(const Track& track) {
  constexpr double kMostSigmaM = 4.2;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      track.kinematics.position_covariance_m2(), Eigen::EigenvaluesOnly);
  return !is_vehicle(track) || axes.eigenvalues()(1) > kMostSigmaM * kMostSigmaM;
}

}  // namespace

ExpectedView expected_view(const Track& track, const ScanView& view, const TrackingConfig& config) {
  constexpr double kMarginM = 0.3;
  constexpr double kMostErrorM = 1.0;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(
      track.kinematics.position_covariance_m2() +
      common_error_covariance(track, track.footprint().heading_rad, config));
  const Vector2d step_m =
      std::sqrt(3.0 * std::max(0.0, axes.eigenvalues()(1))) * axes.eigenvectors().col(1);
  // An echo this near may be the object's own.
  const double margin_m = kMarginM + std::min(kMostErrorM, step_m.norm() / std::sqrt(3.0));
  struct Node {
    double offset;
    double weight;
  };
  constexpr std::array<Node, 3> kNodes = {{{0.0, 2.0 / 3.0}, {-1.0, 1.0 / 6.0}, {1.0, 1.0 / 6.0}}};
  ExpectedView expected;
  for (const Node& node : kNodes) {
    const BeamCounts counts =
        count_beams(track.footprint(), track.position_m() + node.offset * step_m, margin_m, view);
    if (counts.beams == 0) continue;
    expected.in_view += node.weight;
    expected.visible += node.weight * counts.visible / counts.beams;
    expected.passed += node.weight * counts.passed / counts.beams;
  }
  return expected;
}

void follow_occlusion(Track& track, const ScanView& view, const TrackingConfig& config) {
  constexpr double kMostVisible = 0.5;
  constexpr double kSurelyVisible = 0.9;
  constexpr double kLongHiddenS = 1.0;
  constexpr double kUnseenAfterS = 0.05;
  History& history = track.history;
  const double unseen_s = static_cast<double>(view.scan().stamp_ns - history.last_seen_ns) * 1e-9;
  if (!track.existence.confirmed || history.misses == 0 || unseen_s < kUnseenAfterS) {
    history.is_hidden = history.is_unseen = false;
    return;
  }
  const ExpectedView expected = expected_view(track, view, config);
  if (expected.in_view < 0.5) {  // another scanner may see it
    history.is_unseen = false;
    return;
  }
  history.is_unseen = expected.visible < kSurelyVisible || history.is_unseen;
  history.expected_passed = expected.passed;
  history.is_hidden = expected.visible < kMostVisible ||
                      (history.is_hidden && unseen_s > kLongHiddenS && is_place_forgotten(track));
}

}  // namespace slammot::tracking
