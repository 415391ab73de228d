#include "common/sensing/floor_survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "common/sensing/repeated_lines.hpp"

namespace slammot::sensing {
namespace {

using geometry::Vector2;

constexpr std::size_t kFewestFloorViews = 30;
constexpr std::size_t kFewestFloorBeams = 16;
constexpr double kLeastSway = 0.03;     // of the floor's inverse distance
constexpr double kRangeError_m = 0.04;  // of an echo of the floor
constexpr double kJudgedCosine = 0.5;   // of the beams that are compared, to the line's normal

double inverse_range_per_m(float reading, const SurveyedBeams& beams) {
  const double range_m = beams.unit_m * static_cast<double>(reading);
  return range_m > 0.0 && range_m < beams.no_echo_m ? 1.0 / range_m : 0.0;
}

InverseScans inverse_scans_of(std::span<const FloorSurvey::View> views,
                              const SurveyedBeams& beams) {
  InverseScans scans;
  scans.beam_step_rad = beams.beam_step_rad;
  for (std::size_t beam = 0; beam < views.front().readings.size(); ++beam) {
    const double angle_rad = beams.first_beam_rad + beams.beam_step_rad * static_cast<double>(beam);
    scans.direction.emplace_back(std::cos(angle_rad), std::sin(angle_rad));
  }
  for (const FloorSurvey::View& view : views) {
    std::vector<double>& per_m = scans.per_m.emplace_back();
    for (const float reading : view.readings) per_m.push_back(inverse_range_per_m(reading, beams));
  }
  return scans;
}

/// How much nearer than the floor an echo of it may be, along a beam with this inverse range of the
/// floor [1/m].
double tolerance_per_m(const RepeatedLine& floor, double floor_per_m) {
  return std::max(3.0 * floor.spread, kLeastSway) * floor.inverse_distance_per_m() +
         kRangeError_m * floor_per_m * floor_per_m;
}

/// Least squares over the echoes near the line, at all bearings.
RepeatedLine fitted(RepeatedLine floor, const InverseScans& scans) {
  constexpr int kIterations = 8;
  for (int i = 0; i < kIterations; ++i) {
    geometry::Matrix2 information = geometry::Matrix2::Zero();
    Vector2 sum = Vector2::Zero();
    for (std::size_t beam = 0; beam < scans.direction.size(); ++beam) {
      const Vector2& direction = scans.direction[beam];
      const double floor_per_m = floor.inverse_per_m.dot(direction);
      if (floor_per_m < kJudgedCosine * floor.inverse_distance_per_m()) continue;
      const double tolerance = tolerance_per_m(floor, floor_per_m);
      for (const std::vector<double>& per_m : scans.per_m) {
        if (per_m[beam] == 0.0 || std::abs(per_m[beam] - floor_per_m) > tolerance) continue;
        information += direction * direction.transpose();
        sum += per_m[beam] * direction;
      }
    }
    if (information.determinant() <= 0.0) return floor;
    floor.inverse_per_m = information.inverse() * sum;
  }
  return floor;
}

/// What the views say of a line.
struct LineEvidence {
  std::size_t on = 0;  ///< Echoes.
  std::size_t beyond = 0;
  std::array<std::size_t, 2> views{};    ///< On straights and in turns.
  std::array<std::size_t, 2> with_it{};  ///< Of these, with the line.
  std::size_t on_in_turns = 0;           ///< Echoes,
  std::size_t past_in_turns = 0;         ///< and those that are farther than sway explains.

  std::size_t all_with_it() const { return with_it[0] + with_it[1]; }
  double share_of_views() const {
    return static_cast<double>(all_with_it()) / static_cast<double>(views[0] + views[1]);
  }
};

struct EchoesByLine {
  std::size_t on = 0;
  std::size_t past = 0;    ///< Farther than sway explains.
  std::size_t beyond = 0;  ///< Of these, clearly.
};

EchoesByLine echoes_by_line(const RepeatedLine& floor, const InverseScans& scans,
                            const std::vector<double>& per_m) {
  constexpr double kBeyond = 0.25;  // of the floor's inverse distance
  EchoesByLine echoes;
  for (std::size_t beam = 0; beam < per_m.size(); ++beam) {
    const double floor_per_m = floor.inverse_per_m.dot(scans.direction[beam]);
    if (per_m[beam] == 0.0 || floor_per_m < kJudgedCosine * floor.inverse_distance_per_m())
      continue;
    const double tolerance = tolerance_per_m(floor, floor_per_m);
    const double nearer_per_m = per_m[beam] - floor_per_m;
    echoes.on += std::abs(nearer_per_m) < tolerance ? 1 : 0;
    echoes.past += nearer_per_m <= -tolerance ? 1 : 0;
    echoes.beyond +=
        nearer_per_m < -std::max(tolerance, kBeyond * floor.inverse_distance_per_m()) ? 1 : 0;
  }
  return echoes;
}

LineEvidence evidence_of(const RepeatedLine& floor, const InverseScans& scans,
                         std::span<const FloorSurvey::View> views) {
  const std::size_t fewest_on = scans.beams_within(0.5 * kChord_rad);
  LineEvidence evidence;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const EchoesByLine echoes = echoes_by_line(floor, scans, scans.per_m[i]);
    const std::size_t way = views[i].is_in_turn ? 1 : 0;
    evidence.on += echoes.on;
    evidence.beyond += echoes.beyond;
    ++evidence.views[way];
    if (echoes.on < fewest_on) continue;
    ++evidence.with_it[way];
    if (!views[i].is_in_turn) continue;
    evidence.on_in_turns += echoes.on;
    evidence.past_in_turns += echoes.past;
  }
  return evidence;
}

/// True for a line beside the vehicle that is seen less often in turns: a wall along the way.
bool may_be_a_wall(const RepeatedLine& floor, const LineEvidence& evidence,
                   double laser_heading_rad) {
  constexpr double kFewestInTurns = 5.0;
  constexpr double kLeastInTurns = 0.5;  // of its share of the views on straights
  const double bearing_rad =
      std::atan2(floor.inverse_per_m.y(), floor.inverse_per_m.x()) + laser_heading_rad;
  const double expected_in_turns = static_cast<double>(evidence.with_it[0] * evidence.views[1]) /
                                   static_cast<double>(std::max<std::size_t>(1, evidence.views[0]));
  return lies_beside(bearing_rad) &&
         static_cast<double>(evidence.with_it[1]) <
             std::max(kFewestInTurns, kLeastInTurns * expected_in_turns);
}

constexpr double kFewestWithIt = 15.0;

/// Single echoes meet any line; stretches of it are seen of a line that is there.
bool is_seen_often(const RepeatedLine& mode, std::size_t views) {
  constexpr double kLeastShare = 0.15;
  return static_cast<double>(mode.scans) >=
         std::max(kFewestWithIt, kLeastShare * static_cast<double>(views));
}

bool is_met_often(const LineEvidence& evidence) {
  constexpr double kLeastShare = 0.25;
  return static_cast<double>(evidence.all_with_it()) >= kFewestWithIt &&
         evidence.share_of_views() >= kLeastShare;
}

/// Of the echoes on a floor and beyond. Walls have openings and ends: of the lines of the recorded
/// logs at least a fifth of the echoes lies beyond.
constexpr double kMostBeyond = 0.03;

/// In turns a wall comes nearer on one side and goes farther away on the other; the floor turns
/// with the vehicle.
bool is_aslant_in_turns(const LineEvidence& evidence) {
  return static_cast<double>(evidence.past_in_turns) >
         kMostBeyond * static_cast<double>(evidence.on_in_turns + evidence.past_in_turns);
}

bool is_last(const LineEvidence& evidence) {
  return static_cast<double>(evidence.beyond) <=
         kMostBeyond * static_cast<double>(evidence.on + evidence.beyond);
}

struct Floor {
  RepeatedLine line;
  LineEvidence evidence;

  double worth() const { return static_cast<double>(evidence.on) / (kLeastSway + line.spread); }
};

std::optional<Floor> floor_near(const RepeatedLine& mode, const InverseScans& scans,
                                std::span<const FloorSurvey::View> views,
                                double laser_heading_rad) {
  constexpr double kMostSpread = 0.05;  // of walls at any distance: 0.09
  if (mode.spread > kMostSpread || !is_seen_often(mode, views.size())) return std::nullopt;
  const RepeatedLine line = fitted(mode, scans);
  const LineEvidence evidence = evidence_of(line, scans, views);
  if (!is_met_often(evidence) || !is_last(evidence) || is_aslant_in_turns(evidence) ||
      may_be_a_wall(line, evidence, laser_heading_rad))
    return std::nullopt;
  return Floor{line, evidence};
}

std::optional<Floor> most_worth(const InverseScans& scans, std::span<const FloorSurvey::View> views,
                                double laser_heading_rad) {
  std::optional<Floor> best;
  for (const RepeatedLine& mode : repeated_lines(scans)) {
    const auto floor = floor_near(mode, scans, views, laser_heading_rad);
    if (floor && (!best || floor->worth() > best->worth())) best = floor;
  }
  return best;
}

std::vector<float> nearest_echoes_of(const RepeatedLine& floor, const InverseScans& scans,
                                     double unit_m) {
  std::vector<float> from;
  for (const Vector2& direction : scans.direction) {
    const double floor_per_m = floor.inverse_per_m.dot(direction);
    const double nearest_per_m = floor_per_m + tolerance_per_m(floor, floor_per_m);
    from.push_back(nearest_per_m > 0.0 ? static_cast<float>(1.0 / (nearest_per_m * unit_m))
                                       : std::numeric_limits<float>::infinity());
  }
  return from;
}

/// Of the beams of all views, those with an echo that is not the floor's.
double share_of_others(std::span<const FloorSurvey::View> views, const std::vector<float>& from,
                       const SurveyedBeams& beams) {
  std::size_t others = 0;
  for (const FloorSurvey::View& view : views) {
    for (std::size_t beam = 0; beam < from.size(); ++beam) {
      const float reading = view.readings[beam];
      others += reading < from[beam] && inverse_range_per_m(reading, beams) > 0.0 ? 1 : 0;
    }
  }
  return static_cast<double>(others) / static_cast<double>(views.size() * from.size());
}

}  // namespace

bool lies_beside(double bearing_rad) {
  constexpr double kBeside = 0.8;  // sine: 53 degrees
  return std::abs(std::sin(bearing_rad)) > kBeside;
}

void FloorInView::hide(std::span<float> readings, float nothing) const {
  if (readings.size() != from.size()) return;
  for (std::size_t beam = 0; beam < readings.size(); ++beam)
    if (readings[beam] >= from[beam]) readings[beam] = nothing;
}

bool FloorSurvey::has_moved(const geometry::Pose2& wheel_from_base) const {
  constexpr double kStep_m = 0.3;
  constexpr double kTurn_rad = 0.2;
  return (wheel_from_base.translation_m() - last_pose_.translation_m()).norm() > kStep_m ||
         std::abs(geometry::wrap_angle(wheel_from_base.heading_rad - last_pose_.heading_rad)) >
             kTurn_rad;
}

void FloorSurvey::add(std::span<const float> readings, const geometry::Pose2& wheel_from_base,
                      bool is_another_view) {
  constexpr double kTurn_rad = 0.05;
  if (!views_.kept().empty() && readings.size() != beams()) return;
  if (!is_another_view && !has_moved(wheel_from_base)) return;
  const double turned_rad =
      std::abs(geometry::wrap_angle(wheel_from_base.heading_rad - last_pose_.heading_rad));
  last_pose_ = wheel_from_base;
  views_.add({{readings.begin(), readings.end()}, turned_rad > kTurn_rad});
}

FloorInView FloorSurvey::conclude(const SurveyedBeams& beams) const {
  const std::vector<View>& views = views_.kept();
  if (views.size() < kFewestFloorViews || this->beams() < kFewestFloorBeams ||
      beams.beam_step_rad == 0.0)
    return {};
  const InverseScans scans = inverse_scans_of(views, beams);
  const auto floor = most_worth(scans, views, beams.laser_heading_rad);
  if (!floor) return {};
  const Vector2& line = floor->line.inverse_per_m;
  FloorInView found{.from = nearest_echoes_of(floor->line, scans, beams.unit_m),
                    .distance_m = 1.0 / line.norm(),
                    .bearing_rad = std::atan2(line.y(), line.x()),
                    .share_of_views = floor->evidence.share_of_views()};
  found.share_of_beams = share_of_others(views, found.from, beams);
  return found;
}

}  // namespace slammot::sensing
