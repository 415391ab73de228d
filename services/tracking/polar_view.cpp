#include "services/tracking/polar_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/full_turn.hpp"

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;
using geometry::wrap_angle;

constexpr double kRoughErrorRad = 1e-4;
constexpr long kBeamsAside = 2;  ///< Beams on each side of a place's own that may have met it.
constexpr double kLongestSideM = 3.0;  ///< Between neighbouring echoes of one surface.

/// Direction to within kRoughErrorRad, rounding included, without the arctangent: a minimax odd
/// polynomial.
double rough_angle_rad(const Vector2d& way) {
  const double x = std::abs(way.x());
  const double y = std::abs(way.y());
  // at the laser itself any direction is right
  const double slope = std::min(x, y) / std::max({x, y, std::numeric_limits<double>::min()});
  const double slope2 = slope * slope;
  const double slope4 = slope2 * slope2;
  // two independent halves
  const double below_diagonal_rad =
      slope * (0.99921417 - 0.32117868 * slope2 + slope4 * (0.14627357 - 0.03899266 * slope2));
  const double from_x_axis_rad =
      y > x ? 0.5 * std::numbers::pi - below_diagonal_rad : below_diagonal_rad;
  return std::copysign(way.x() < 0.0 ? std::numbers::pi - from_x_axis_rad : from_x_axis_rad,
                       way.y());
}

/// Replaces each value by the extreme one among it and kBeamsAside neighbours on each side; beyond
/// the ends is `nothing`.
template <typename Extreme>
void spread_to_neighbours(std::vector<double>& values, double nothing, const Extreme& extreme) {
  constexpr std::size_t kAside = kBeamsAside;
  std::array<double, kAside + 1> before;  // overwritten values and the current one, newest last
  before.fill(nothing);
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::rotate(before.begin(), before.begin() + 1, before.end());
    before.back() = values[i];
    for (const double value : before) values[i] = extreme(values[i], value);
    for (std::size_t next = i + 1; next <= std::min(i + kAside, values.size() - 1); ++next)
      values[i] = extreme(values[i], values[next]);
  }
}

}  // namespace

void PolarView::look_at(const flow::SegmentedScan& scan) {
  range_m_ = scan.range_m;
  depths_.nearest_m.clear();
  depths_.farthest_m.clear();
  laser_in_odom_m_ = scan.odom_from_base.pose * scan.base_from_laser.translation_m();
  first_beam_in_odom_rad_ = 0.0;
  beam_step_rad_ = std::abs(scan.beam_step_rad);
  beams_per_rad_ = 1.0 / beam_step_rad_;
  sweep_s_ = scan.sweep_s;
  half_view_rad_ = 0.5 * beam_step_rad_ * static_cast<double>(scan.range_m.size());
  is_clockwise_ = scan.beam_step_rad < 0.0;
  goes_all_round_ = geometry::goes_all_round(scan.range_m.size(), scan.beam_step_rad);
  const Eigen::Matrix2d R = geometry::rotation(scan.odom_from_base.pose.heading_rad);
  const Vector2d t = scan.odom_from_base.pose.translation_m();
  points_in_odom_m_.resize(scan.range_m.size());
  bool knows_direction = false;
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    points_in_odom_m_[beam] = R * scan.points_in_base_m[beam].cast<double>() + t;
    if (knows_direction || scan.range_m[beam] <= 0.0F) continue;
    // The scan does not carry the direction of its first beam; the first echo tells it, up to the
    // motion during the sweep.
    const Vector2d way = points_in_odom_m_[beam] - laser_in_odom_m_;
    first_beam_in_odom_rad_ =
        std::atan2(way.y(), way.x()) - static_cast<double>(beam) * scan.beam_step_rad;
    knows_direction = true;
  }
  middle_of_view_rad_ =
      (is_clockwise_ ? -first_beam_in_odom_rad_ : first_beam_in_odom_rad_) + half_view_rad_;
}

/// A point of a side is at most half its length from the nearer end: this bounds the interval.
void PolarView::measure_depths() {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const std::size_t count = range_m_.size();
  depths_.nearest_m.assign(count, kNever);
  depths_.farthest_m.assign(count, -kNever);
  double before_m = -kNever;  // distance of the previous echo
  for (std::size_t beam = 0; beam < count; before_m = depths_.farthest_m[beam++]) {
    if (range_m_[beam] <= 0.0F) continue;
    depths_.nearest_m[beam] = depths_.farthest_m[beam] =
        (points_in_odom_m_[beam] - laser_in_odom_m_).norm();
    if (beam == 0 || range_m_[beam - 1] <= 0.0F) continue;
    const double length2 = (points_in_odom_m_[beam] - points_in_odom_m_[beam - 1]).squaredNorm();
    if (length2 <= kLongestSideM * kLongestSideM)
      depths_.nearest_m[beam] =
          std::min(depths_.farthest_m[beam], before_m) - 0.5 * std::sqrt(length2);
  }
  spread_to_neighbours(depths_.nearest_m, kNever,
                       [](double a, double b) { return std::min(a, b); });
  spread_to_neighbours(depths_.farthest_m, -kNever,
                       [](double a, double b) { return std::max(a, b); });
}

bool PolarView::is_sound() const {
  constexpr double kNarrowestRad = 1e-5;
  return points_in_odom_m_.size() == range_m_.size() && beam_step_rad_ > kNarrowestRad &&
         beams_per_rad_ == 1.0 / beam_step_rad_ &&
         half_view_rad_ == 0.5 * beam_step_rad_ * static_cast<double>(range_m_.size());
}

std::optional<std::size_t> PolarView::neighbour_of(std::size_t beam, long steps) const {
  const auto count = static_cast<long>(range_m_.size());
  long neighbour = static_cast<long>(beam) + steps;
  if (goes_all_round_) neighbour = (neighbour % count + count) % count;
  if (neighbour < 0 || neighbour >= count) return std::nullopt;
  return static_cast<std::size_t>(neighbour);
}

std::size_t PolarView::steps_between(std::size_t from, std::size_t to) const {
  if (to >= from) return to - from;
  return goes_all_round_ ? range_m_.size() - from + to : range_m_.size();
}

double PolarView::steps_towards(double direction_in_odom_rad) const {
  const double turned = is_clockwise_ ? -1.0 : 1.0;
  return (half_view_rad_ +
          wrap_angle(turned * (direction_in_odom_rad - first_beam_in_odom_rad_) - half_view_rad_)) /
         beam_step_rad_;
}

bool PolarView::any_echo_near(const Vector2d& point_in_odom_m, double within_m,
                              const std::function<bool(std::size_t)>& counts) const {
  const Vector2d way = point_in_odom_m - laser_in_odom_m_;
  const double distance_m = way.norm();
  const double half_width = distance_m <= within_m
                                ? static_cast<double>(range_m_.size())
                                : std::asin(within_m / distance_m) / beam_step_rad_;
  const double middle = steps_towards(std::atan2(way.y(), way.x()));
  const auto last = static_cast<double>(range_m_.size());
  const auto first_beam =
      static_cast<std::size_t>(std::clamp(std::floor(middle - half_width), 0.0, last));
  const auto end_beam =
      static_cast<std::size_t>(std::clamp(std::ceil(middle + half_width) + 1.0, 0.0, last));
  for (std::size_t beam = first_beam; beam < end_beam; ++beam)
    if (range_m_[beam] > 0.0F &&
        (points_in_odom_m_[beam] - point_in_odom_m).squaredNorm() < within_m * within_m &&
        counts(beam))
      return true;
  return false;
}

double PolarView::delay_towards_s(const Vector2d& point_in_odom_m) const {
  const auto last = static_cast<long>(beam_count()) - 1;
  return last < 0 ? 0.0
                  : delay_s(static_cast<std::size_t>(
                        std::clamp(beam_towards(point_in_odom_m - laser_in_odom_m_), 0L, last)));
}

long PolarView::beam_towards(const Vector2d& way) const {
  constexpr double kFullTurn = 2.0 * std::numbers::pi;
  double off_middle_rad =
      rough_angle_rad({way.x(), is_clockwise_ ? -way.y() : way.y()}) - middle_of_view_rad_;
  if (off_middle_rad > std::numbers::pi) off_middle_rad -= kFullTurn;
  if (off_middle_rad < -std::numbers::pi) off_middle_rad += kFullTurn;
  const double steps = half_view_rad_ * beams_per_rad_ + off_middle_rad * beams_per_rad_;
  // std::lround() but for ties, which are not sure
  const auto beam = static_cast<long>(steps + std::copysign(0.5, steps));
  const bool is_sure =
      std::abs(steps - static_cast<double>(beam)) < 0.5 - kRoughErrorRad * beams_per_rad_ &&
      std::abs(off_middle_rad) + kRoughErrorRad < std::numbers::pi;
  return is_sure ? beam : std::lround(steps_towards(std::atan2(way.y(), way.x())));
}

/// Without examining beams: a place is at least as far from an echo as their distances from the
/// laser differ.
bool PolarView::may_have_met(long middle, double distance_m, double within_m) const {
  constexpr double kNoRoundingM = 1e-6;
  const auto beam = static_cast<std::size_t>(middle);
  return depths_.nearest_m.empty() ||
         (distance_m + within_m + kNoRoundingM > depths_.nearest_m[beam] &&
          distance_m - within_m - kNoRoundingM < depths_.farthest_m[beam]);
}

/// The first beam about the middle one whose echo, or the side between it and the next echo, is
/// within this distance; kNoBeam if none.
std::size_t PolarView::beam_that_met(const Vector2d& point_in_odom_m, long middle,
                                     double within_m) const {
  const long first = std::max(0L, middle - kBeamsAside);
  const long last = std::min(static_cast<long>(range_m_.size()) - 1, middle + kBeamsAside);
  for (long i = first; i <= last; ++i) {
    const auto beam = static_cast<std::size_t>(i);
    if (range_m_[beam] <= 0.0F) continue;
    const Vector2d off = point_in_odom_m - points_in_odom_m_[beam];
    if (off.squaredNorm() < within_m * within_m) return beam;
    if (i == last || range_m_[beam + 1] <= 0.0F) continue;
    // Between two echoes of one oblique surface the place is seen although no beam met it.
    const Vector2d side = points_in_odom_m_[beam + 1] - points_in_odom_m_[beam];
    const double length2 = side.squaredNorm();
    if (length2 > kLongestSideM * kLongestSideM) continue;
    const double share = std::clamp(side.dot(off) / std::max(length2, 1e-9), 0.0, 1.0);
    if ((off - share * side).squaredNorm() < within_m * within_m) return beam;
  }
  return kNoBeam;
}

SightOfPlace PolarView::sight_of(const Vector2d& point_in_odom_m) const {
  constexpr double kSamePlaceM = 0.25;
  constexpr double kSamePlacePerM = 0.005;
  constexpr double kBeyondM = 0.35;
  constexpr double kBeyondPerM = 0.008;
  const Vector2d way = point_in_odom_m - laser_in_odom_m_;
  const double distance_m = way.norm();
  const long middle = beam_towards(way);
  if (middle < 1 || middle + 1 >= static_cast<long>(range_m_.size())) return {};
  const double near_m = kSamePlaceM + kSamePlacePerM * distance_m;
  if (may_have_met(middle, distance_m, near_m)) {
    if (const std::size_t beam = beam_that_met(point_in_odom_m, middle, near_m); beam != kNoBeam)
      return {Sight::kThere, beam};
  }
  const double margin_m = kBeyondM + kBeyondPerM * distance_m;
  int through = 0;
  int empty = 0;
  for (long i = middle - 1; i <= middle + 1; ++i) {
    const double range_m = static_cast<double>(range_m_[static_cast<std::size_t>(i)]);
    if (range_m > 0.0 && range_m < distance_m - margin_m)
      return {Sight::kHidden, static_cast<std::size_t>(i)};
    // A beam without echo may have met a dark surface: it does not count as passed.
    if (range_m > distance_m + margin_m) ++through;
    if (range_m <= 0.0) ++empty;
  }
  if (through >= 2 && range_m_[static_cast<std::size_t>(middle)] > 0.0F)
    return {Sight::kThrough, static_cast<std::size_t>(middle)};
  constexpr double kEchoesWithinM = 8.0;
  if (empty == 3 && distance_m < kEchoesWithinM)
    return {Sight::kEmpty, static_cast<std::size_t>(middle)};
  return {};
}

}  // namespace slammot::tracking
