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

/// Indices in the scene.
VehicleBoxRow box_row(std::size_t scan, const Scene& scene, std::size_t of_object,
                      std::size_t of_track) {
  const TrueObject& object = scene.objects[of_object];
  const ReportedTrack& track = scene.tracks[of_track];
  return {scan,
          of_object,
          of_track,
          intersection_over_union(box_of(object), box_of(track)),
          geometry::inverse(object.world_from_object) * track.world_from_object,
          velocity_error_mps(object, track)};
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
  void add(const VehicleBoxRow& row) {
    iou_.push_back(row.iou);
    centre_m_.push_back(row.object_from_track.translation_m().norm());
    heading_rad_.push_back(std::abs(row.object_from_track.heading_rad));
    velocity_mps_.push_back(row.velocity_mps);
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

std::vector<VehicleBoxRow> vehicle_box_rows(const std::vector<Scene>& scenes,
                                            const std::vector<CountedScene>& counted,
                                            const ClearMot& matched) {
  std::unordered_map<std::size_t, std::int64_t> first_ns;
  std::vector<VehicleBoxRow> rows;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    for (const std::size_t row : counted[i].objects)
      first_ns.try_emplace(scenes[i].objects[row].object, scenes[i].stamp_ns);
    for (const auto& [row, column] : matched.matches[i]) {
      const std::size_t of_object = counted[i].objects[row];
      const std::size_t of_track = counted[i].tracks[column];
      const TrueObject& object = scenes[i].objects[of_object];
      if (!is_vehicle(object) || scenes[i].stamp_ns - first_ns.at(object.object) < kInViewNs)
        continue;
      rows.push_back(box_row(i, scenes[i], of_object, of_track));
    }
  }
  return rows;
}

VehicleBoxErrors vehicle_box_errors(const std::vector<Scene>& scenes,
                                    const std::vector<CountedScene>& counted,
                                    const ClearMot& matched) {
  BoxRows all;
  std::array<BoxRows, kOutlineBands.size()> by_outline;
  for (const VehicleBoxRow& row : vehicle_box_rows(scenes, counted, matched)) {
    all.add(row);
    by_outline[outline_band(scenes[row.scan].objects[row.object])].add(row);
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
