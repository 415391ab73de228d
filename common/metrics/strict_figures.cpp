#include "common/metrics/strict_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "common/metrics/box_overlap.hpp"
#include "common/metrics/coverage.hpp"

namespace slammot::metrics {
namespace {

using geometry::Vector2;

constexpr std::int64_t kInViewNs = 2'000'000'000;
constexpr double kLeastIou = 0.3;
constexpr double kNearM = 0.5;

bool is_vehicle(const TrueObject& object) {
  return object.object_class == "car" || object.object_class == "truck" ||
         object.object_class == "bus";
}

double centre_distance_m(const TrueObject& object, const ReportedTrack& track) {
  return (track.world_from_object.translation_m() - object.world_from_object.translation_m())
      .norm();
}

double velocity_error_mps(const TrueObject& object, const ReportedTrack& track) {
  const Vector2 velocity_mps =
      geometry::rotation(object.world_from_object.heading_rad) * Vector2(object.speed_mps, 0.0);
  return (track.velocity_in_world_mps - velocity_mps).norm();
}

/// Of ascending values; 0 without any.
double quantile(const std::vector<double>& ascending, double share) {
  if (ascending.empty()) return 0.0;
  const double position = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return std::lerp(ascending[below], ascending[above], position - static_cast<double>(below));
}

/// Errors of rows, to be summarized.
class BoxRows {
 public:
  void add(const TrueObject& object, const ReportedTrack& track) {
    iou_.push_back(intersection_over_union(box_of(object), box_of(track)));
    centre_m_.push_back(centre_distance_m(object, track));
    heading_rad_.push_back(std::abs(geometry::wrap_angle(track.world_from_object.heading_rad -
                                                         object.world_from_object.heading_rad)));
    velocity_mps_.push_back(velocity_error_mps(object, track));
  }

  BoxErrors errors() && {
    std::ranges::sort(iou_);
    return {iou_.size(),
            quantile(iou_, 0.5),
            quantile(iou_, 0.1),
            summarize(std::move(centre_m_)),
            summarize(std::move(heading_rad_)),
            summarize(std::move(velocity_mps_))};
  }

 private:
  std::vector<double> iou_, centre_m_, heading_rad_, velocity_mps_;
};

std::size_t outline_band(const TrueObject& object) {
  const auto* const above = std::ranges::upper_bound(kOutlineBands, object.outline_seen);
  return static_cast<std::size_t>(above - kOutlineBands.begin()) - 1;
}

bool is_same(const TrueObject& object, const ReportedTrack& track) {
  return object.object_class == "pedestrian"
             ? centre_distance_m(object, track) <= kNearM
             : intersection_over_union(box_of(object), box_of(track)) >= kLeastIou;
}

}  // namespace

VehicleBoxErrors vehicle_box_errors(const std::vector<Scene>& scenes,
                                    const std::vector<CountedScene>& counted,
                                    const ClearMot& matched) {
  std::unordered_map<std::size_t, std::int64_t> first_ns;
  BoxRows all;
  std::array<BoxRows, kOutlineBands.size()> by_outline;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const std::size_t row : counted[i].objects)
      first_ns.try_emplace(scenes[i].objects[row].object, scenes[i].stamp_ns);
    for (const auto& [row, column] : matched.matches[i]) {
      const TrueObject& object = scenes[i].objects[counted[i].objects[row]];
      const ReportedTrack& track = scenes[i].tracks[counted[i].tracks[column]];
      if (!is_vehicle(object) || scenes[i].stamp_ns - first_ns.at(object.object) < kInViewNs)
        continue;
      all.add(object, track);
      by_outline[outline_band(object)].add(object, track);
    }
  }
  VehicleBoxErrors errors{std::move(all).errors(), {}};
  for (std::size_t band = 0; band < by_outline.size(); ++band)
    errors.by_outline[band] = std::move(by_outline[band]).errors();
  return errors;
}

Hota strict_hota(const std::vector<Scene>& scenes, const std::vector<CountedScene>& counted,
                 std::size_t object_count, std::size_t track_count) {
  MotSequence sequence{object_count, track_count, {}};
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    MotFrame frame = counted[i].frame;
    for (std::size_t row = 0; row < counted[i].objects.size(); ++row) {
      for (std::size_t column = 0; column < counted[i].tracks.size(); ++column)
        frame.similarity(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) =
            is_same(scenes[i].objects[counted[i].objects[row]],
                    scenes[i].tracks[counted[i].tracks[column]])
                ? 1.0
                : 0.0;
    }
    sequence.frames.push_back(std::move(frame));
  }
  return hota(sequence);
}

double StoppedRows::covered_share() const {
  return rows == 0 ? 0.0 : static_cast<double>(covered_rows) / static_cast<double>(rows);
}

StoppedRows stopped_rows(const std::vector<Scene>& scenes, const CountingRule& rule) {
  StoppedRows stopped;
  for (const auto& [object, timeline] : covered_timelines(scenes, rule)) {
    bool has_moved = false;
    for (const CoveredMoment& moment : timeline) {
      const TrueObject& truth = *moment.truth;
      const bool is_moving = std::abs(truth.speed_mps) >= rule.least_speed_mps;
      has_moved = has_moved || is_moving;
      if (is_moving || !has_moved || truth.points < rule.least_points ||
          !is_in_view(truth.world_from_object, scenes[moment.scan], rule))
        continue;
      ++stopped.rows;
      stopped.covered_rows += moment.track ? 1 : 0;
    }
  }
  return stopped;
}

}  // namespace slammot::metrics
