#include "services/tracking/body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "common/geometry/pose2.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

// Lengths are those of real road users, to be scaled with them.
constexpr double kFaceDepthM = 0.15;      ///< Points this near the outermost one lie on the same side,
constexpr double kFaceDepthSigmas = 3.0;  ///< or so many of their own standard deviations.
constexpr double kNothingKnownM2 = 1e6;   ///< Variance of a size that was never seen.
constexpr double kUnknownSigmaM = 3.0;    ///< Of a coordinate about which a glimpse says nothing.
constexpr int kFewestOnFlank = 3;         ///< Echoes on a flank that tell where it ends.
constexpr double kWidestM = 3.2;          ///< Nothing on the road is wider;
constexpr double kWidestFaceM = 2.6;      ///< a side that is not longer may be a face.
constexpr double kWholeSigmaM = 0.06;     ///< Errors of a size that is seen again and again do not average below this.

double squared(double value) { return value * value; }

/// The glimpse along one axis of the body, relative to the predicted centre.
struct Projection {
  double low_m = std::numeric_limits<double>::max();
  double high_m = std::numeric_limits<double>::lowest();
  Edge low_edge = Edge::kOpen;   ///< Beyond the outermost point, where it is the first or last.
  Edge high_edge = Edge::kOpen;
  int count = 0;
  /// Of the outermost points towards the laser, the low ones or the high ones:
  double face_m = 0.0;           ///< their mean,
  double face_across_m = 0.0;    ///< how far they lie apart across the axis: a side does, the end of a flank does not.
  int face_count = 0;
};

struct AxisMeasurement {
  double centre_m = 0.0;
  double variance_m2 = kUnknownSigmaM * kUnknownSigmaM;
  std::optional<int> held;       ///< -1: the low side was seen, +1: the high one; the size grows from there. 0: both.
};

struct Spread {
  double least_m = std::numeric_limits<double>::max();
  double most_m = std::numeric_limits<double>::lowest();
  void include(double value_m) { least_m = std::min(least_m, value_m), most_m = std::max(most_m, value_m); }
  double width_m() const { return most_m - least_m; }
  bool has_in_middle(double value_m) const {
    constexpr double kEndShare = 0.2;
    return value_m >= least_m + kEndShare * width_m() && value_m <= most_m - kEndShare * width_m();
  }
};

/// Mean of what lies on a side; not of its ends, which are round, if that leaves enough.
class SideMean {
 public:
  void include(double at_m, bool is_in_middle) { sum_m_ += at_m, ++count_; if (is_in_middle) middle_sum_m_ += at_m, ++middle_count_; }
  double mean_m() const {
    constexpr int kFewestInMiddle = 3;
    return middle_count_ >= kFewestInMiddle ? middle_sum_m_ / middle_count_ : sum_m_ / count_;
  }
  int count() const { return count_; }

 private:
  double sum_m_ = 0.0;
  double middle_sum_m_ = 0.0;
  int count_ = 0;
  int middle_count_ = 0;
};

/// Without its face.
Projection span_of(const Observation& observation, const Vector2d& centre_m, const Vector2d& axis) {
  Projection projection;
  const std::size_t count = observation.points_m.size();
  std::size_t lowest = 0;
  std::size_t highest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = axis.dot(observation.points_m[i] - centre_m);
    if (s < projection.low_m) projection.low_m = s, lowest = i;
    if (s > projection.high_m) projection.high_m = s, highest = i;
  }
  const auto edge_beside = [&](std::size_t point) {
    const Edge before = point == 0 ? observation.start : Edge::kOpen;
    return point + 1 == count ? std::max(before, observation.end) : before;
  };
  projection.low_edge = edge_beside(lowest);
  projection.high_edge = edge_beside(highest);
  projection.count = static_cast<int>(count);
  return projection;
}

Projection projection_of(const Observation& observation, const Vector2d& centre_m, const Vector2d& axis, double face_depth_m) {
  Projection projection = span_of(observation, centre_m, axis);
  const double inwards = axis.dot(observation.laser_m - centre_m) < 0.0 ? 1.0 : -1.0;
  const double behind_face_m = (inwards > 0.0 ? projection.low_m : -projection.high_m) + face_depth_m;
  const auto across_of = [&](const Vector2d& point) { return axis.x() * point.y() - axis.y() * point.x(); };
  Spread across;
  for (const Vector2d& point : observation.points_m)
    if (inwards * axis.dot(point - centre_m) < behind_face_m) across.include(across_of(point));
  SideMean face;
  for (const Vector2d& point : observation.points_m) {
    const double s = axis.dot(point - centre_m);
    if (inwards * s < behind_face_m) face.include(s, across.has_in_middle(across_of(point)));
  }
  projection.face_m = face.mean_m();
  projection.face_across_m = across.width_m();
  projection.face_count = face.count();
  return projection;
}

Projection mirrored(const Projection& projection) {
  return {-projection.high_m, -projection.low_m, projection.high_edge, projection.low_edge, projection.count, -projection.face_m, projection.face_across_m, projection.face_count};
}

/// No body is smaller than what is seen of it; a single outlier does not make it larger.
void note_seen(SizeEvidence& evidence, double seen_m) {
  constexpr double kTrust = 0.3;
  if (seen_m > evidence.least_m) evidence.least_m += evidence.least_m == 0.0 ? seen_m : kTrust * (seen_m - evidence.least_m);
}

/// A size seen from edge to edge.
struct SeenWhole {
  double size_m = 0.0;
  double variance_m2 = 1.0;
  double missed_share = 0.0;  ///< Of the corners' depth.
};

void note_whole(SizeEvidence& evidence, const SeenWhole& seen, double scale) {
  constexpr double kShorterM = 0.5;       // than what was seen before: a piece, or a side seen askew
  constexpr double kForgotten = 0.02;     // of it, for each scan that says so: it may have been several things
  constexpr double kSharedShare = 0.25;   // of the variance: neighbouring scans err alike, so that many know little more than one
  const bool is_shorter = seen.size_m < evidence.least_m - kShorterM * scale;
  evidence.least_m = std::min(evidence.least_m, evidence.least_m + kForgotten * (seen.size_m - evidence.least_m));
  if (is_shorter) return;
  const double least_variance_m2 = std::max(squared(kWholeSigmaM * scale), kSharedShare * seen.variance_m2);
  if (evidence.whole.variance_m2 <= kSharedShare * seen.variance_m2) return;
  const double gain = evidence.whole.variance_m2 / (evidence.whole.variance_m2 + seen.variance_m2);
  evidence.whole.value_m += gain * (seen.size_m - evidence.whole.value_m);
  evidence.missed_share += gain * (seen.missed_share - evidence.missed_share);
  evidence.whole.variance_m2 = std::max(least_variance_m2, (1.0 - gain) * evidence.whole.variance_m2);
}

/// What is missed of a corner of this depth. Cuts and circles differ.
Size missed_of(const Size& corner, double share) {
  constexpr double kShapeShare = 0.2;
  return {share * corner.value_m, squared(share) * corner.variance_m2 + squared(std::min(share, kShapeShare) * corner.value_m)};
}

/// How the laser looks at an end of a side.
struct EndView {
  double spacing_m = 0.0;           ///< Between the echoes there.
  double missed_share = 0.0;        ///< Of the depth of its corner: so much farther the body goes than beams meet it.
};

/// One axis of a body and how the laser looks at it.
struct AxisView {
  double laser_at_m = 0.0;          ///< Relative to the predicted centre.
  double face_variance_m2 = 0.0;    ///< Of one echo from a side across the axis.
  EndView low;                      ///< Of a side along the axis.
  EndView high;
  double gaps = 0.0;                ///< Beams in a row that were not answered, in the mean.
  double least_side_m = 0.4;        ///< What is narrower is no side.
  double clear_spacing_m = 0.5;     ///< Wider spaced echoes do not tell where a side ends.
  double scale = 1.0;               ///< Of all sizes, against those of real road users.
  bool is_length = true;            ///< Along which a flank goes; across it, an echo of a flank is where its side is.
  Size corner;                      ///< How deep the corners are.
};

/// Whether the end towards the laser is a side across the axis, and not where something hides the rest of a flank.
bool is_side(const Projection& projection, const AxisView& view) {
  return projection.face_count >= 3 && projection.face_across_m > view.least_side_m;
}

/// How far a side goes on beyond its outermost echo without being answered, in the mean, and one sigma of that.
double unanswered_m(const AxisView& view, const EndView& end, Edge edge) {
  constexpr double kMostM = 1.3;  // a car on which all places are as likely
  return edge == Edge::kNoEcho ? std::min(view.gaps * end.spacing_m, kMostM * view.scale) : 0.0;
}

/// How far beyond its outermost echo a flat side goes on in the mean: half a spacing, or as many as go unanswered in a row.
double flat_beyond_m(const AxisView& view, const EndView& end, Edge edge) { return 0.5 * end.spacing_m + unanswered_m(view, end, edge); }

/// Variance of where that is.
double flat_end_variance_m2(const AxisView& view, const EndView& end, Edge edge) {
  return view.face_variance_m2 + end.spacing_m * end.spacing_m / 12.0 + squared(unanswered_m(view, end, edge));
}

/// The same of the body, whose corner is round.
double beyond_m(const AxisView& view, const EndView& end, Edge edge) { return flat_beyond_m(view, end, edge) + missed_of(view.corner, end.missed_share).value_m; }
double end_variance_m2(const AxisView& view, const EndView& end, Edge edge) {
  return flat_end_variance_m2(view, end, edge) + missed_of(view.corner, end.missed_share).variance_m2;
}

/// The laser lies beyond the low side, which so looks at it; the high end is at the end of a flank, if that is in view.
void note_sizes_from_low_side(SizeEvidence& evidence, const Projection& projection, const AxisView& view, bool flank_is_visible) {
  const double low_m = projection.face_count >= 3 ? projection.face_m : projection.low_m;
  note_seen(evidence, projection.high_m - low_m);
  const bool low_is_seen = projection.low_edge == Edge::kOpen || is_side(projection, view);
  const bool high_is_seen = flank_is_visible && projection.high_edge != Edge::kHidden && view.high.spacing_m < view.clear_spacing_m &&
                            projection.count - projection.face_count >= kFewestOnFlank;
  if (low_is_seen && high_is_seen)  // the flank ends somewhere between its last echo and where the next one would be
    note_whole(evidence, {projection.high_m + flat_beyond_m(view, view.high, projection.high_edge) - low_m, flat_end_variance_m2(view, view.high, projection.high_edge), view.high.missed_share}, view.scale);
}

void note_sizes_from_beside(SizeEvidence& evidence, const Projection& projection, const AxisView& view) {
  note_seen(evidence, projection.high_m - projection.low_m);
  const double spacing_m = std::max(view.low.spacing_m, view.high.spacing_m);
  if (projection.low_edge != Edge::kHidden && projection.high_edge != Edge::kHidden && spacing_m < view.clear_spacing_m && projection.count >= kFewestOnFlank)
    note_whole(evidence, {projection.high_m - projection.low_m + flat_beyond_m(view, view.low, projection.low_edge) + flat_beyond_m(view, view.high, projection.high_edge),
                          flat_end_variance_m2(view, view.low, projection.low_edge) + flat_end_variance_m2(view, view.high, projection.high_edge),
                          view.low.missed_share + view.high.missed_share}, view.scale);
}

/// Whether so few beams are answered that the outermost echoes are likely not those of the ends, of which nothing hides any.
bool may_end_anywhere(const Projection& projection, const AxisView& view) {
  constexpr double kDarkGaps = 0.5;
  return view.is_length && view.gaps > kDarkGaps && std::max(projection.low_edge, projection.high_edge) == Edge::kNoEcho;
}

/// Few echoes from anywhere on a flank of this length, as many as chance has it at its ends: the middle is between where it would be
/// if the first of them, and if the last, was an end, and all places between are as likely.
AxisMeasurement centre_from_few(const Size& size, const Projection& projection, const AxisView& view) {
  const double unseen_m = std::max(0.0, size.value_m - (projection.high_m - projection.low_m));
  const double spacing_m = std::max(view.low.spacing_m, view.high.spacing_m);
  return {0.5 * (projection.low_m + projection.high_m), view.face_variance_m2 + squared(spacing_m) / 12.0 + squared(unseen_m) / 12.0, 0};
}

/// The laser lies beside the body: both ends are outlines of the flank.
AxisMeasurement centre_from_beside(const Size& size, const Projection& projection, const AxisView& view) {
  if (may_end_anywhere(projection, view)) return centre_from_few(size, projection, view);
  AxisMeasurement axis;
  const double low_m = projection.low_m - beyond_m(view, view.low, projection.low_edge) + 0.5 * size.value_m;
  const double high_m = projection.high_m + beyond_m(view, view.high, projection.high_edge) - 0.5 * size.value_m;
  const bool low_is_seen = projection.low_edge != Edge::kHidden;
  const bool high_is_seen = projection.high_edge != Edge::kHidden;
  const double low_variance_m2 = end_variance_m2(view, view.low, projection.low_edge);
  const double high_variance_m2 = end_variance_m2(view, view.high, projection.high_edge);
  // Where the two ends disagree, part of the body was not seen: the difference says how much the middle may be off.
  if (low_is_seen && high_is_seen) {
    axis.held = 0;
    axis.centre_m = 0.5 * (low_m + high_m);
    axis.variance_m2 = 0.25 * (low_variance_m2 + high_variance_m2) + 0.25 * (low_m - high_m) * (low_m - high_m);
  } else if (low_is_seen) {
    axis.centre_m = low_m, axis.variance_m2 = low_variance_m2, axis.held = -1;
  } else if (high_is_seen) {
    axis.centre_m = high_m, axis.variance_m2 = high_variance_m2, axis.held = 1;
  }
  return axis;
}

AxisMeasurement centre_from_low_side(const Size& size, const Projection& projection, const AxisView& view, bool flank_is_visible) {
  AxisMeasurement axis;
  if (may_end_anywhere(projection, view) && !is_side(projection, view) && flank_is_visible) return centre_from_few(size, projection, view);
  if (projection.low_edge != Edge::kHidden || is_side(projection, view)) {
    const double low_m = projection.face_count >= 3 ? projection.face_m : projection.low_m;
    axis.centre_m = low_m + 0.5 * size.value_m;
    axis.variance_m2 = is_side(projection, view) ? view.face_variance_m2 : end_variance_m2(view, view.low, projection.low_edge);
    axis.held = -1;
  } else if (flank_is_visible && projection.high_edge == Edge::kOpen) {
    axis.centre_m = projection.high_m + beyond_m(view, view.high, projection.high_edge) - 0.5 * size.value_m;
    axis.variance_m2 = end_variance_m2(view, view.high, projection.high_edge);
    axis.held = 1;
  }
  return axis;
}

AxisView mirrored(const AxisView& view) {
  return {-view.laser_at_m, view.face_variance_m2, view.high, view.low, view.gaps, view.least_side_m, view.clear_spacing_m, view.scale, view.is_length, view.corner};
}

std::optional<int> mirrored(std::optional<int> held) { return held ? std::optional(-*held) : std::nullopt; }

AxisMeasurement mirrored(const AxisMeasurement& axis) { return {-axis.centre_m, axis.variance_m2, mirrored(axis.held)}; }

/// Variance of the step between the centre as measured from one end and as measured from another.
double step_variance_m2(std::optional<int> held_before, std::optional<int> held, const Size& size) {
  return held_before && held ? squared(0.5 * (*held - *held_before)) * size.variance_m2 : 0.0;
}

void learn_sizes(SizeEvidence& evidence, const Size& size, const Projection& projection, const AxisView& view, bool flank_is_visible) {
  if (std::abs(view.laser_at_m) <= 0.5 * size.value_m) note_sizes_from_beside(evidence, projection, view);
  else if (view.laser_at_m < 0.0) note_sizes_from_low_side(evidence, projection, view, flank_is_visible);
  else note_sizes_from_low_side(evidence, mirrored(projection), mirrored(view), flank_is_visible);
}

AxisMeasurement measure_axis(const Size& size, const Projection& projection, const AxisView& view, bool flank_is_visible) {
  if (std::abs(view.laser_at_m) <= 0.5 * size.value_m) return centre_from_beside(size, projection, view);
  if (view.laser_at_m < 0.0) return centre_from_low_side(size, projection, view, flank_is_visible);
  return mirrored(centre_from_low_side(size, mirrored(projection), mirrored(view), flank_is_visible));
}

/// Of the depth of a corner, as much is not met by beams that graze the side before it at an angle of this sine: a cut at 45 degrees
/// hides all of itself behind the side up to that angle and nothing beyond, a quarter circle r (1 - sine), of r = 1.7 depths.
double missed_share(double sine) { return std::min(1.15, 2.0 * (1.0 - sine)); }

/// The end of a side along the axis, at the place.
EndView end_view(const Observation& observation, const Vector2d& place_m, const Vector2d& axis) {
  constexpr double kLeastIncidence = 0.05;
  const Vector2d sight_m = place_m - observation.laser_m;
  const double range_m = std::max(sight_m.norm(), 1e-3);
  const double sine = std::min(1.0, std::abs(axis.x() * sight_m.y() - axis.y() * sight_m.x()) / range_m);
  return {range_m * observation.beam_step_rad / std::max(sine, kLeastIncidence), missed_share(sine)};
}

/// The side of the body that looks at the laser, along one axis: where it is, and the way inwards. None where too little of it is seen.
struct NearSide {
  double at_m = 0.0;
  double inwards = 1.0;
};

std::optional<NearSide> near_side(const Size& size, const Projection& projection, const AxisView& view) {
  const double beyond_m = std::abs(view.laser_at_m) - 0.5 * size.value_m;
  if (beyond_m < 0.0 || !is_side(projection, view)) return std::nullopt;
  return NearSide{projection.face_m, view.laser_at_m < 0.0 ? 1.0 : -1.0};
}

/// What one glimpse of both sides tells of the corner between them. None where its echoes are too far apart to tell.
std::optional<Size> seen_corner(const Observation& observation, const Vector2d& centre_m, const Vector2d& along, const AxisView& u_view, const AxisView& v_view, const NearSide& u, const NearSide& v) {
  constexpr double kWidestSpacingM = 0.3;
  constexpr double kDeepestM = 0.7;     // farther off the echo next to the corner is missing
  constexpr double kNextEchoShare = 0.25;      // of the spacing: so far from a sharp corner its nearest echo is in the mean,
  constexpr double kNextEchoSigmaShare = 0.3;  // and one sigma of it
  constexpr double kNearestSigmas = 1.0;       // by which noise brings the nearest of the few echoes on a cut nearer
  constexpr double kSidesSigmaM = 0.04;
  const Vector2d across{-along.y(), along.x()};
  const double spacing_m = std::min(u.inwards > 0.0 ? u_view.low.spacing_m : u_view.high.spacing_m, v.inwards > 0.0 ? v_view.low.spacing_m : v_view.high.spacing_m);
  if (spacing_m > kWidestSpacingM * u_view.scale) return std::nullopt;
  double depth_m = std::numeric_limits<double>::max();
  for (const Vector2d& point : observation.points_m)
    depth_m = std::min(depth_m, u.inwards * (along.dot(point - centre_m) - u.at_m) + v.inwards * (across.dot(point - centre_m) - v.at_m));
  if (depth_m > kDeepestM * u_view.scale) return std::nullopt;
  const double sharp_share = std::clamp(1.0 - depth_m / spacing_m, 0.0, 1.0);  // a cut that is longer than the spacing has an echo
  return Size{std::max(0.0, depth_m - kNextEchoShare * sharp_share * spacing_m + kNearestSigmas * (1.0 - sharp_share) * std::sqrt(u_view.face_variance_m2)),
              u_view.face_variance_m2 + squared(kNextEchoSigmaShare * spacing_m) + squared(kSidesSigmaM * u_view.scale)};
}

/// With what one more scan says; neighbouring scans err alike.
Size with_corner(const Size& before, const Size& seen, double scale) {
  constexpr double kLeastSigmaM = 0.02;
  const double gain = before.variance_m2 / (before.variance_m2 + seen.variance_m2);
  return {before.value_m + gain * (seen.value_m - before.value_m), std::max(squared(kLeastSigmaM * scale), (1.0 - gain) * before.variance_m2)};
}

/// Beams in a row that were not answered, in the mean.
double gaps_in_a_row(const Observation& observation) { return observation.unanswered_share / (1.0 - observation.unanswered_share); }

/// A glimpse along both axes of a body, and which of its sides look at the laser.
struct BoxProjection {
  Vector2d along = Vector2d::UnitX();
  Vector2d across = Vector2d::UnitY();
  Projection u;
  Projection v;
  AxisView u_view;
  AxisView v_view;
  bool flank_is_visible = false;
  bool face_is_visible = false;
};

BoxProjection box_projection_of(const Body& body, const Vector2d& predicted_centre_m, const Observation& observation, const TrackingConfig& config) {
  BoxProjection seen;
  seen.along = {std::cos(body.heading_rad), std::sin(body.heading_rad)};
  seen.across = {-seen.along.y(), seen.along.x()};
  const Vector2d to_laser_m = observation.laser_m - predicted_centre_m;
  const double sigma_m = std::hypot(echo_sigma_m(to_laser_m.norm(), config), config.shape_noise_m);
  const double face_depth_m = kFaceDepthM * config.size_scale + kFaceDepthSigmas * sigma_m;
  seen.u = projection_of(observation, predicted_centre_m, seen.along, face_depth_m);
  seen.v = projection_of(observation, predicted_centre_m, seen.across, face_depth_m);
  const double gaps = gaps_in_a_row(observation);
  const Size corner = corner_of(body, body.kind, config);
  const auto view_of = [&](const Vector2d& axis, const Projection& projection) {
    return AxisView{axis.dot(to_laser_m), squared(sigma_m), end_view(observation, predicted_centre_m + projection.low_m * axis, axis),
                    end_view(observation, predicted_centre_m + projection.high_m * axis, axis), gaps, 0.4 * config.size_scale, 0.5 * config.size_scale, config.size_scale, true, corner};
  };
  seen.u_view = view_of(seen.along, seen.u);
  seen.v_view = view_of(seen.across, seen.v);
  seen.v_view.is_length = false;
  const double clear_m = 0.3 * config.size_scale;
  seen.flank_is_visible = std::abs(seen.v_view.laser_at_m) > 0.5 * body.width.value_m + clear_m;
  seen.face_is_visible = std::abs(seen.u_view.laser_at_m) > 0.5 * body.length.value_m + clear_m;
  return seen;
}

/// A size under one kind of road users, whatever the least that was seen at once.
Size size_from_whole(double mean_m, double sigma_m, const SizeEvidence& evidence) {
  const double information = 1.0 / squared(sigma_m) + 1.0 / evidence.whole.variance_m2;
  return {(mean_m / squared(sigma_m) + evidence.whole.value_m / evidence.whole.variance_m2) / information, 1.0 / information};
}

Size likely_size(double mean_m, double sigma_m, const SizeEvidence& evidence) {
  const Size size = size_from_whole(mean_m, sigma_m, evidence);
  return {std::max(size.value_m, evidence.least_m), size.variance_m2};
}

double log_likelihood_of_least(const Size& size, double least_m, double scale) {
  constexpr double kLeastSigmaM = 0.2;
  const double beyond_m = std::max(0.0, least_m - size.value_m);
  return -0.5 * squared(beyond_m) / (size.variance_m2 + squared(kLeastSigmaM * scale));
}

/// A size under one kind of road users.
struct AxisFit {
  double log_fit = 0.0;
  Size size;
};

/// What was taken for the whole may have been a piece, between two things that hide the rest: then only the kind tells how
/// large the body is.
AxisFit axis_fit(double mean_m, double sigma_m, const SizeEvidence& evidence, double scale, double log_piece_density) {
  constexpr double kMistakenShare = 0.05;
  const double as_whole = log_likelihood_of_size(mean_m, sigma_m, evidence, scale);
  const Size whole = likely_size(mean_m, sigma_m, evidence);
  if (evidence.whole.variance_m2 >= kNothingKnownM2) return {as_whole, whole};
  const Size piece = likely_size(mean_m, sigma_m, {evidence.least_m, {0.0, kNothingKnownM2}});
  const double as_piece = log_piece_density + log_likelihood_of_least({mean_m, squared(sigma_m)}, evidence.least_m, scale);
  const double of_whole = std::log(1.0 - kMistakenShare) + as_whole;
  const double of_piece = std::log(kMistakenShare) + as_piece;
  const double piece_share = 1.0 / (1.0 + std::exp(of_whole - of_piece));
  const bool is_piece = piece_share > 0.5;
  Size size = is_piece ? piece : whole;
  size.variance_m2 = piece_share * piece.variance_m2 + (1.0 - piece_share) * whole.variance_m2 +
                     std::min(piece_share, 1.0 - piece_share) * squared(piece.value_m - whole.value_m);
  return {log_sum(of_whole, of_piece), size};
}

/// The sizes under one kind of road users, and how well they fit it.
struct KindFit {
  double log_fit = 0.0;
  AxisFit length;
  AxisFit width;
};

using KindFits = std::array<KindFit, std::tuple_size_v<decltype(RoadUsers::kinds)>>;

/// Of each kind of road users.
KindFits kind_fits(const Body& body, const TrackingConfig& config) {
  constexpr double kLongestPieceM = 16.0;
  const double scale = config.size_scale;
  const double log_piece_density = std::log(std::sqrt(2.0 * std::numbers::pi) / (kLongestPieceM * scale));  // the other one's leaves the root out
  const EvidenceByKind evidence = evidence_by_kind(body, config);
  const auto fit_of = [&](const KindOfBody& kind) {
    KindFit fit;
    if (kind.share <= 0.0) return KindFit{-std::numeric_limits<double>::max(), {}, {}};
    fit.length = axis_fit(scale * kind.length_m, scale * kind.length_sigma_m, evidence.of(kind.kind).length, scale, log_piece_density);
    fit.width = axis_fit(scale * kind.width_m, scale * kind.width_sigma_m, evidence.of(kind.kind).width, scale, log_piece_density);
    fit.log_fit = kind.log_share + fit.length.log_fit + fit.width.log_fit;
    return fit;
  };
  KindFits fits;
  std::ranges::transform(body.road_users->kinds, fits.begin(), fit_of);
  return fits;
}

/// What was seen from edge to edge goes on by what the corners are round.
SizeEvidence with_corners(SizeEvidence evidence, const Size& corner) {
  const Size missed = missed_of(corner, evidence.missed_share);
  evidence.whole.value_m += missed.value_m;
  evidence.whole.variance_m2 += missed.variance_m2;
  return evidence;
}

EvidenceOfSizes with_corners(const Body& body, const Size& corner) {
  return {with_corners(body.length_evidence, corner), with_corners(body.width_evidence, corner)};
}

}  // namespace

Size corner_of(const Body& body, Kind kind, const TrackingConfig& config) {
  if (kind == Kind::kBicycle || only_people_move(config)) return {0.0, 0.0};
  const double prior_m2 = squared(config.size_scale) * body.road_users->corner.variance_m2;
  const double gain = prior_m2 / (prior_m2 + body.corner_seen.variance_m2);
  const double prior_m = config.size_scale * body.road_users->corner.value_m;
  return {prior_m + gain * (body.corner_seen.value_m - prior_m), (1.0 - gain) * prior_m2};
}

EvidenceByKind evidence_by_kind(const Body& body, const TrackingConfig& config) {
  return {with_corners(body, corner_of(body, Kind::kBicycle, config)), with_corners(body, corner_of(body, Kind::kCar, config))};
}

double log_sum(double a, double b) { return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b))); }

double log_likelihood_of_size(double mean_m, double sigma_m, const SizeEvidence& evidence, double scale) {
  const double variance_m2 = squared(sigma_m) + evidence.whole.variance_m2;
  return -0.5 * squared(evidence.whole.value_m - mean_m) / variance_m2 - 0.5 * std::log(variance_m2) +
         std::min(log_likelihood_of_least({mean_m, squared(sigma_m)}, evidence.least_m, scale),
                  log_likelihood_of_least(size_from_whole(mean_m, sigma_m, evidence), evidence.least_m, scale));
}

Body with_likely_sizes(Body body, const TrackingConfig& config) {
  const KindFits fits = kind_fits(body, config);
  const auto best = std::ranges::max_element(fits, {}, &KindFit::log_fit);
  body.kind = body.road_users->kinds[static_cast<std::size_t>(best - fits.begin())].kind;
  body.length = {best->length.size.value_m, 0.0};
  body.width = {best->width.size.value_m, 0.0};
  double total = 0.0;
  for (const KindFit& fit : fits) {  // how far off the likeliest is, should another kind be true
    const double weight = std::exp(fit.log_fit - best->log_fit);
    total += weight;
    body.length.variance_m2 += weight * (fit.length.size.variance_m2 + squared(fit.length.size.value_m - body.length.value_m));
    body.width.variance_m2 += weight * (fit.width.size.variance_m2 + squared(fit.width.size.value_m - body.width.value_m));
  }
  body.length.variance_m2 /= total;
  body.width.variance_m2 /= total;
  body.length.value_m = std::min(body.length.value_m, config.longest_body_m);
  body.width.value_m = std::min(body.width.value_m, kWidestM * config.size_scale);
  return body;
}

double log_evidence_of_sizes(const Body& body, const TrackingConfig& config) {
  double sum = -std::numeric_limits<double>::max();
  for (const KindFit& fit : kind_fits(body, config)) sum = log_sum(sum, fit.log_fit);
  return sum;
}

BodyMeasurement measure_box(const Body& body, const Vector2d& predicted_centre_m, const Observation& observation,
                            const TrackingConfig& config) {
  const auto& [along, across, u, v, u_view, v_view, flank_is_visible, face_is_visible] = box_projection_of(body, predicted_centre_m, observation, config);
  BodyMeasurement measurement;
  measurement.body = body;
  const std::optional<NearSide> near_u = near_side(body.length, u, u_view);
  const std::optional<NearSide> near_v = near_side(body.width, v, v_view);
  if (near_u && near_v) {
    const std::optional<Size> seen = seen_corner(observation, predicted_centre_m, along, u_view, v_view, *near_u, *near_v);
    if (seen) measurement.body.corner_seen = with_corner(body.corner_seen, *seen, config.size_scale);
  }
  learn_sizes(measurement.body.length_evidence, body.length, u, u_view, flank_is_visible);
  learn_sizes(measurement.body.width_evidence, body.width, v, v_view, face_is_visible);
  if (!body.is_oriented) {  // only what a body cannot be smaller than, whichever way it lies
    for (const auto size : {&Body::length_evidence, &Body::width_evidence}) {
      (measurement.body.*size).whole = (body.*size).whole;
      (measurement.body.*size).missed_share = (body.*size).missed_share;
    }
  }
  measurement.body = with_likely_sizes(measurement.body, config);
  const AxisMeasurement at_u = measure_axis(measurement.body.length, u, u_view, flank_is_visible);
  const AxisMeasurement at_v = measure_axis(measurement.body.width, v, v_view, face_is_visible);
  measurement.centre_m = predicted_centre_m + at_u.centre_m * along + at_v.centre_m * across;
  measurement.covariance_m2 = at_u.variance_m2 * along * along.transpose() + at_v.variance_m2 * across * across.transpose();
  const double longer_m = measurement.body.length.value_m - body.length.value_m;
  const double wider_m = measurement.body.width.value_m - body.width.value_m;
  measurement.recentring_m = -0.5 * at_u.held.value_or(0) * longer_m * along - 0.5 * at_v.held.value_or(0) * wider_m * across;
  measurement.step_covariance_m2 = step_variance_m2(body.length_held, at_u.held, measurement.body.length) * along * along.transpose() +
                                   step_variance_m2(body.width_held, at_v.held, measurement.body.width) * across * across.transpose();
  if (at_u.held) measurement.body.length_held = at_u.held;
  if (at_v.held) measurement.body.width_held = at_v.held;
  return measurement;
}

Vector2d box_centre_m(const Body& body, const Vector2d& predicted_centre_m, const Observation& observation, const TrackingConfig& config) {
  const BoxProjection seen = box_projection_of(body, predicted_centre_m, observation, config);
  return predicted_centre_m + measure_axis(body.length, seen.u, seen.u_view, seen.flank_is_visible).centre_m * seen.along +
         measure_axis(body.width, seen.v, seen.v_view, seen.face_is_visible).centre_m * seen.across;
}

BodyMeasurement measure_blob(const Body& body, const Observation& observation, const TrackingConfig& config) {
  BodyMeasurement measurement;
  Vector2d mean_m = Vector2d::Zero();
  for (const Vector2d& point : observation.points_m) mean_m += point;
  mean_m /= static_cast<double>(observation.points_m.size());
  const Vector2d sight_m = mean_m - observation.laser_m;
  const double range_m = std::max(sight_m.norm(), 1e-3);
  const Vector2d along = sight_m / range_m;
  const Vector2d across{-along.y(), along.x()};
  const double extent_m = extent_of(observation.points_m);
  constexpr double kSurfaceToMiddleM = 0.08;  // pi/4 of half the depth: of a coat 0.1, of legs 0.06
  constexpr double kBetweenLegsM = 0.25;
  constexpr double kMostM = 1.3;
  const double gap_m = std::clamp(gaps_in_a_row(observation) * range_m * observation.beam_step_rad - kBetweenLegsM * config.size_scale, 0.0, kMostM * config.size_scale);
  const double shape_m = std::hypot(config.blob_noise_share * extent_m, config.shape_noise_m, gap_m);  // something dark is seen now here, now there
  const double sigma_along_m = std::hypot(echo_sigma_m(range_m, config), shape_m);
  const double sigma_across_m = std::hypot(range_m * observation.beam_step_rad / 3.5, shape_m);
  measurement.centre_m = mean_m + kSurfaceToMiddleM * config.size_scale * along;
  measurement.covariance_m2 = sigma_along_m * sigma_along_m * along * along.transpose() +
                              sigma_across_m * sigma_across_m * across * across.transpose();
  measurement.body = body;
  const double grown_m = std::max(extent_m, body.length.value_m);
  measurement.body.length.value_m = body.length.value_m + 0.2 * (grown_m - body.length.value_m);
  measurement.body.width.value_m = measurement.body.length.value_m;
  measurement.body.was_seen_whole = body.was_seen_whole || (observation.start == Edge::kOpen && observation.end == Edge::kOpen);
  return measurement;
}

Body likely_box(double box_heading_rad, const Observation& observation, const TrackingConfig& config, const RoadUsers& road_users) {
  const auto span_along = [&](double heading_rad) {
    const Vector2d axis{std::cos(heading_rad), std::sin(heading_rad)};
    const Projection projection = span_of(observation, observation.points_m.front(), axis);
    return projection.high_m - projection.low_m;
  };
  constexpr double kQuarterRad = 0.5 * std::numbers::pi;
  constexpr double kNarrowestM = 1.2;
  const double longer_m = span_along(box_heading_rad);
  const double shorter_m = span_along(box_heading_rad + kQuarterRad);
  const bool is_face = longer_m > kNarrowestM * config.size_scale && longer_m < kWidestFaceM * config.size_scale &&
                       shorter_m < 0.5 * longer_m;
  Body body;
  body.road_users = &road_users;
  body.has_sides = true;
  body.heading_rad = geometry::wrap_angle(box_heading_rad + (is_face ? kQuarterRad : 0.0));
  body.heading_variance_rad2 = is_face ? 0.3 : 0.1;
  body.is_oriented = longer_m > kWidestM * config.size_scale;
  body.length_evidence.least_m = is_face ? shorter_m : longer_m;
  body.width_evidence.least_m = is_face ? longer_m : shorter_m;
  return with_likely_sizes(body, config);
}

bool is_plausible(const Body& body, const TrackingConfig& config) {
  return !body.has_sides || (body.width_evidence.least_m < kWidestM * config.size_scale && body.length_evidence.least_m < config.longest_body_m);
}

Vector2d supposed_centre_m(const Body& body, const Observation& observation) {
  const Vector2d along{std::cos(body.heading_rad), std::sin(body.heading_rad)};
  const Vector2d across{-along.y(), along.x()};
  const Vector2d origin_m = observation.points_m.front();
  const Projection u = span_of(observation, origin_m, along);
  const Projection v = span_of(observation, origin_m, across);
  const Vector2d middle_m = origin_m + 0.5 * (u.low_m + u.high_m) * along + 0.5 * (v.low_m + v.high_m) * across;
  const Vector2d sight_m = middle_m - observation.laser_m;
  const double unseen_along_m = std::max(0.0, body.length.value_m - (u.high_m - u.low_m));
  const double unseen_across_m = std::max(0.0, body.width.value_m - (v.high_m - v.low_m));
  // What is not seen of it lies behind what is.
  const bool is_face = u.high_m - u.low_m < v.high_m - v.low_m;
  const double back_along_m = is_face || std::abs(along.dot(sight_m)) > 0.5 * body.length.value_m ? 0.5 * unseen_along_m : 0.0;
  const double back_across_m = is_face ? 0.0 : 0.5 * unseen_across_m;
  return middle_m + std::copysign(back_along_m, along.dot(sight_m)) * along + std::copysign(back_across_m, across.dot(sight_m)) * across;
}

Body turned_by_a_quarter(Body body, double sense, const TrackingConfig& config) {
  body.heading_rad = geometry::wrap_angle(body.heading_rad + std::copysign(0.5 * std::numbers::pi, sense));
  body.heading_variance_rad2 = std::max(body.heading_variance_rad2, 0.3);
  std::swap(body.length_evidence, body.width_evidence);
  body.length_held.reset();
  body.width_held.reset();
  body.length_evidence.whole = {};  // measured for a body that lay otherwise
  body.width_evidence.whole = {};
  body.length_evidence.whole.variance_m2 = body.width_evidence.whole.variance_m2 = kNothingKnownM2;
  return with_likely_sizes(body, config);
}

Body turned_about(Body body) {
  body.heading_rad = geometry::wrap_angle(body.heading_rad + std::numbers::pi);
  body.length_held = mirrored(body.length_held);
  body.width_held = mirrored(body.width_held);
  return body;
}

double extent_of(std::span<const Vector2d> points_m) {
  double extent_m = 0.0;
  constexpr double kRootHalf = 0.70710678;
  for (const Vector2d& axis : {Vector2d(1.0, 0.0), Vector2d(0.0, 1.0), Vector2d(kRootHalf, kRootHalf), Vector2d(kRootHalf, -kRootHalf)}) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const Vector2d& point : points_m) {
      const double s = axis.dot(point);
      low = std::min(low, s), high = std::max(high, s);
    }
    extent_m = std::max(extent_m, high - low);
  }
  return extent_m;
}

Vector2d offset_from_box(const Body& body, const Vector2d& centre_m, double margin_m, const Vector2d& point_m) {
  const double c = std::cos(body.heading_rad);
  const double s = std::sin(body.heading_rad);
  const Vector2d d = point_m - centre_m;
  const auto beyond = [](double value, double half) { return std::copysign(std::max(0.0, std::abs(value) - half), value); };
  const double u = beyond(c * d.x() + s * d.y(), 0.5 * body.length.value_m + margin_m);
  const double v = beyond(-s * d.x() + c * d.y(), 0.5 * body.width.value_m + margin_m);
  return {c * u - s * v, s * u + c * v};
}

bool is_in_box(const Body& body, const Vector2d& centre_m, double margin_m, const Vector2d& point_m) {
  const double reach_m = std::max(0.0, 0.5 * (body.length.value_m + body.width.value_m) + 2.0 * margin_m);
  return (point_m - centre_m).squaredNorm() <= reach_m * reach_m && offset_from_box(body, centre_m, margin_m, point_m).isZero();
}

}  // namespace slammot::tracking
