#include "services/tracking/face_shift.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kFewestEchoesOfFace = 4;
constexpr double kStraightM = 0.06;  ///< One sigma of echoes of one side about a line, beside their
                                     ///< noise.
constexpr double kNarrowestM = 0.8;  ///< Of a vehicle's front, which may be partly hidden.
constexpr double kWidestFaceM = 2.8;
constexpr double kMiddleShare = 0.8;  ///< Of the side: at its ends the flanks begin.
constexpr double kFarthestM = 1.2;    ///< Largest displacement of a slow object.
constexpr double kLeastShiftM = 0.08;
constexpr double kLeastShiftPerM = 0.004;  ///< Of range: errors of the heading, and the change of
                                           ///< view of a distant side.
constexpr double kShiftSigmas = 4.0;

/// A straight line through echoes.
struct Face {
  Vector2d middle_m = Vector2d::Zero();
  Vector2d along = Vector2d::UnitX();
  Vector2d normal = Vector2d::UnitY();
  double half_width_m = 0.0;
  double off_m = 0.0;       ///< RMS distance of the echoes from the line.
  double gap_from_m = 0.0;  ///< Along it, from the middle: the gap between two pieces.
  double gap_to_m = 0.0;
};

/// Line through one run of beams, or through two, the later last.
Face face_through(std::span<const std::uint16_t> first, std::span<const std::uint16_t> last,
                  const PolarView& view) {
  const auto count = static_cast<double>(first.size() + last.size());
  Face face;
  for (const auto run : {first, last})
    for (const std::uint16_t beam : run) face.middle_m += view.point_in_odom_m(beam);
  face.middle_m /= count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const auto run : {first, last}) {
    for (const std::uint16_t beam : run) {
      const Vector2d off_m = view.point_in_odom_m(beam) - face.middle_m;
      spread += off_m * off_m.transpose();
    }
  }
  const double heading_rad = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
  face.along = {std::cos(heading_rad), std::sin(heading_rad)};
  face.normal = {-face.along.y(), face.along.x()};
  face.off_m = std::sqrt(std::max(0.0, face.normal.dot(spread * face.normal)) / count);
  const double first_m = face.along.dot(view.point_in_odom_m(first.front()) - face.middle_m);
  const double last_m = face.along.dot(
      view.point_in_odom_m(last.empty() ? first.back() : last.back()) - face.middle_m);
  face.half_width_m = 0.5 * std::abs(last_m - first_m);
  return face;
}

/// The echo farthest from the line through the first and the last.
struct Corner {
  std::size_t index = 0;
  double off_m = 0.0;
};

Corner corner_of(std::span<const std::uint16_t> beams, const PolarView& view) {
  const Vector2d& first_m = view.point_in_odom_m(beams.front());
  const Vector2d way = view.point_in_odom_m(beams.back()) - first_m;
  const double length_m = way.norm();
  Corner corner;
  for (std::size_t i = 1; i + 1 < beams.size(); ++i) {
    const Vector2d off_m = view.point_in_odom_m(beams[i]) - first_m;
    const double distance_m = std::abs(way.x() * off_m.y() - way.y() * off_m.x()) / length_m;
    if (distance_m > corner.off_m) corner = {i, distance_m};
  }
  return corner;
}

struct Sum {
  double count = 0.0, sum = 0.0, squares = 0.0;
  void add(double value) { count += 1.0, sum += value, squares += value * value; }
  double mean() const { return sum / count; }
  double sigma() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean())); }
};

/// One side, or two sides that meet in a corner.
std::array<std::span<const std::uint16_t>, 2> sides_of(std::span<const std::uint16_t> beams,
                                                       const PolarView& view,
                                                       const TrackingConfig& config) {
  constexpr double kCornerM = 0.25;
  const Corner corner = corner_of(beams, view);
  if (corner.off_m <= kCornerM * config.extent.size_scale) return {beams, {}};
  return {beams.first(corner.index + 1), beams.subspan(corner.index)};
}

/// Distance of the face along its normal from here, in an earlier scan. None where it was not fully
/// in view, hidden or bent.
std::optional<double> off_then_m(const Face& face, const PolarView& now, const EarlierScan& then,
                                 double echo_sigma_m, double size_scale) {
  const double farthest_m = kFarthestM * size_scale;
  const PolarView& view = then.view;
  const auto last_beam = static_cast<long>(view.beam_count()) - 1;
  long first = last_beam;
  long last = 0;
  for (const double along_m : {-face.half_width_m, face.half_width_m})
    for (const double off_m : {-farthest_m, farthest_m}) {
      const long beam = view.beam_towards(face.middle_m + along_m * face.along +
                                          off_m * face.normal - view.laser_in_odom_m());
      first = std::min(first, beam), last = std::max(last, beam);
    }
  if (first < 1 || last >= last_beam) return std::nullopt;  // not all of it was in view
  const double outward = std::copysign(1.0, face.normal.dot(face.middle_m - now.laser_in_odom_m()));
  Sum off;
  int through = 0;
  for (long i = first; i <= last; ++i) {
    const auto beam = static_cast<std::size_t>(i);
    if (view.range_m(beam) <= 0.0) continue;
    const Vector2d to_echo_m = view.point_in_odom_m(beam) - face.middle_m;
    const double along_m = face.along.dot(to_echo_m);
    if (std::abs(along_m) > kMiddleShare * face.half_width_m) continue;
    if (along_m > face.gap_from_m && along_m < face.gap_to_m) continue;
    const double off_m = face.normal.dot(to_echo_m);
    if (std::abs(off_m) > farthest_m) {
      through += outward * off_m > 0.0 ? 1 : 0;
      continue;
    }
    if (then.owners[beam].is_confirmed) return std::nullopt;
    off.add(off_m);
  }
  if (off.count < static_cast<double>(kFewestEchoesOfFace) ||
      off.count < static_cast<double>(through))
    return std::nullopt;
  if (off.sigma() > std::hypot(kStraightM * size_scale, echo_sigma_m)) return std::nullopt;
  return off.mean();
}

/// Tolerances of a displacement.
struct Sought {
  double echo_sigma_m = 0.0;
  double least_m = 0.0;
  double size_scale = 1.0;
};

/// Distance of the face from here in the first of the earlier scans in which it was elsewhere, if
/// another agrees on the side and no older one has it here; else zero.
double agreed_off_m(const Face& face, const PolarView& now,
                    std::span<const EarlierScan* const> earlier, const Sought& sought) {
  double first_off_m = 0.0;
  int agreeing = 0;
  for (const EarlierScan* then : earlier) {
    const std::optional<double> off_m =
        off_then_m(face, now, *then, sought.echo_sigma_m, sought.size_scale);
    if (!off_m) continue;
    if (std::abs(*off_m) < sought.least_m) {
      if (agreeing > 0) return 0.0;
      continue;  // too soon for a slow object
    }
    if (first_off_m * *off_m < 0.0) return 0.0;
    if (agreeing == 0) first_off_m = *off_m;
    ++agreeing;
  }
  return agreeing > 1 ? first_off_m : 0.0;
}

/// What a face is compared with.
struct Asked {
  std::span<const EarlierScan* const> earlier;
  const std::function<double()>& pose_sigma_m;
  const TrackingConfig& config;
};

/// A side is at most as wide as its ends are apart: needs no line. Up to rounding.
bool is_surely_too_narrow(std::span<const std::uint16_t> side, const PolarView& view,
                          const TrackingConfig& config) {
  constexpr double kSurely = 1.0 - 1e-9;
  const double most_m = kSurely * kNarrowestM * config.extent.size_scale;
  return (view.point_in_odom_m(side.back()) - view.point_in_odom_m(side.front())).squaredNorm() <
         most_m * most_m;
}

/// Displacement of a face with this number of echoes; zero if it has not moved, or is too narrow,
/// too wide or bent.
Vector2d shift_of(const Face& face, std::size_t echoes, const PolarView& now, const Asked& asked) {
  const TrackingConfig& config = asked.config;
  if (2.0 * face.half_width_m < kNarrowestM * config.extent.size_scale ||
      2.0 * face.half_width_m > kWidestFaceM * config.extent.size_scale)
    return Vector2d::Zero();
  const double range_m = (face.middle_m - now.laser_in_odom_m()).norm();
  const double echo_m = echo_sigma_m(range_m, config);
  if (face.off_m > std::hypot(kStraightM * config.extent.size_scale, echo_m))
    return Vector2d::Zero();
  const double sigma_m =
      std::hypot(asked.pose_sigma_m(), echo_m * std::sqrt(2.0 / static_cast<double>(echoes)));
  const double least_m = std::max(
      kLeastShiftM * config.extent.size_scale + kLeastShiftPerM * range_m, kShiftSigmas * sigma_m);
  return -agreed_off_m(face, now, asked.earlier, {echo_m, least_m, config.extent.size_scale}) *
         face.normal;
}

}  // namespace

std::optional<FaceShift> face_shift(std::span<const std::uint16_t> segment_beams,
                                    const PolarView& now,
                                    std::span<const EarlierScan* const> earlier,
                                    const std::function<double()>& pose_sigma_m,
                                    const TrackingConfig& config) {
  if (segment_beams.size() < kFewestEchoesOfFace) return std::nullopt;
  std::optional<FaceShift> best;
  for (const auto side : sides_of(segment_beams, now, config)) {
    if (side.size() < kFewestEchoesOfFace || is_surely_too_narrow(side, now, config)) continue;
    const Vector2d shift_m =
        shift_of(face_through(side, {}, now), side.size(), now, {earlier, pose_sigma_m, config});
    if (shift_m.isZero() || (best && best->shift_m.norm() > shift_m.norm())) continue;
    best = FaceShift{side, shift_m};
  }
  return best;
}

std::optional<FaceShift> face_shift_with(std::span<const std::uint16_t> other_beams,
                                         std::span<const std::uint16_t> segment_beams,
                                         const PolarView& now,
                                         std::span<const EarlierScan* const> earlier,
                                         const std::function<double()>& pose_sigma_m,
                                         const TrackingConfig& config) {
  if (std::min(segment_beams.size(), other_beams.size()) < kFewestEchoesOfFace) return std::nullopt;
  const auto first = segment_beams.front() < other_beams.front() ? segment_beams : other_beams;
  const auto last = segment_beams.front() < other_beams.front() ? other_beams : segment_beams;
  if (first.back() >= last.front()) return std::nullopt;
  const double width_m =
      (now.point_in_odom_m(last.back()) - now.point_in_odom_m(first.front())).norm();
  if (width_m > kWidestFaceM * config.extent.size_scale) return std::nullopt;
  Face face = face_through(first, last, now);
  const double from_m = face.along.dot(now.point_in_odom_m(first.back()) - face.middle_m);
  const double to_m = face.along.dot(now.point_in_odom_m(last.front()) - face.middle_m);
  face.gap_from_m = std::min(from_m, to_m);
  face.gap_to_m = std::max(from_m, to_m);
  const Vector2d shift_m =
      shift_of(face, first.size() + last.size(), now, {earlier, pose_sigma_m, config});
  if (shift_m.isZero()) return std::nullopt;
  return FaceShift{segment_beams, shift_m};
}

}  // namespace slammot::tracking
