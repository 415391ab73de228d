#include "common/metrics/object_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Cholesky>

#include "common/metrics/share.hpp"

namespace slammot::metrics {
namespace {

using geometry::Vector2;

struct ErrorLists {
  std::size_t rows = 0;
  std::size_t right_class = 0;
  std::map<std::string, std::size_t> reported_as;
  std::vector<double> centre_m, velocity_mps, heading_rad, length_m, width_m, nees;
};

Vector2 velocity_mps(const TrueObject& object) {
  return geometry::rotation(object.world_from_object.heading_rad) * Vector2(object.speed_mps, 0.0);
}

double position_nees(const TrueObject& object, const ReportedTrack& track) {
  const Vector2 error_m =
      track.world_from_object.translation_m() - object.world_from_object.translation_m();
  return error_m.dot(track.position_covariance_m2->ldlt().solve(error_m));
}

void add(const TrueObject& object, const ReportedTrack& track, ErrorLists& lists) {
  lists.right_class += is_same_class(object.object_class, track.object_class) ? 1 : 0;
  ++lists.reported_as[track.object_class];
  lists.centre_m.push_back(
      (track.world_from_object.translation_m() - object.world_from_object.translation_m()).norm());
  lists.velocity_mps.push_back((track.velocity_in_world_mps - velocity_mps(object)).norm());
  lists.heading_rad.push_back(std::abs(geometry::wrap_angle(track.world_from_object.heading_rad -
                                                            object.world_from_object.heading_rad)));
  lists.length_m.push_back(std::abs(track.length_m - object.length_m));
  lists.width_m.push_back(std::abs(track.width_m - object.width_m));
}

ObjectErrors summarize_lists(const ErrorLists& lists) {
  ObjectErrors errors;
  errors.rows = lists.rows;
  errors.matched_rows = lists.centre_m.size();
  errors.recall = share(errors.matched_rows, errors.rows);
  errors.right_class = share(lists.right_class, errors.matched_rows);
  errors.reported_as = lists.reported_as;
  errors.centre_m = summarize(lists.centre_m);
  errors.velocity_mps = summarize(lists.velocity_mps);
  errors.heading_rad = summarize(lists.heading_rad);
  errors.length_m = summarize(lists.length_m);
  errors.width_m = summarize(lists.width_m);
  errors.position_nees = summarize_nees(lists.nees, 2);
  return errors;
}

/// What is known of one object over the whole drive.
struct SeenObject {
  std::int64_t first_counted_ns = 0;
  bool is_detected = false;
  std::int64_t last_nees_ns = std::numeric_limits<std::int64_t>::min() / 2;
};

class Collector {
 public:
  Collector(const std::vector<double>& band_starts_m, double range_m)
      : starts_m_(band_starts_m),
        range_m_(range_m),
        bands_(band_starts_m.size()),
        false_rows_(band_starts_m.size()) {}

  void take(const Scene& scene, const CountedScene& counted, const std::vector<Match>& matches) {
    std::vector<char> is_true(counted.tracks.size(), 0);
    for (const std::size_t row : counted.objects) note_counted(scene.objects[row], scene);
    for (const auto& [row, column] : matches) {
      note_matched(scene.objects[counted.objects[row]], scene.tracks[counted.tracks[column]],
                   scene);
      is_true[column] = 1;
    }
    for (std::size_t column = 0; column < is_true.size(); ++column) {
      if (!is_true[column])
        ++false_rows_[band_of(scene.tracks[counted.tracks[column]].world_from_object, scene)];
    }
  }

  ObjectErrorTables tables() const {
    ObjectErrorTables tables;
    tables.all = summarize_lists(all_);
    for (const auto& [name, lists] : classes_) tables.by_class[name] = summarize_lists(lists);
    for (std::size_t band = 0; band < bands_.size(); ++band) {
      const double to_m = band + 1 < bands_.size() ? starts_m_[band + 1] : range_m_;
      tables.by_distance.push_back(
          {starts_m_[band], to_m, false_rows_[band], summarize_lists(bands_[band])});
    }
    tables.detection_delay_s = summarize(delays_s_);
    for (const auto& [object, history] : objects_)
      tables.never_detected += history.is_detected ? 0 : 1;
    return tables;
  }

 private:
  std::size_t band_of(const geometry::Pose2& world_from_object, const Scene& scene) const {
    const double distance_m =
        (world_from_object.translation_m() - scene.world_from_base.translation_m()).norm();
    const auto after = std::upper_bound(starts_m_.begin(), starts_m_.end(), distance_m);
    return after == starts_m_.begin() ? 0 : static_cast<std::size_t>(after - starts_m_.begin()) - 1;
  }

  void note_counted(const TrueObject& object, const Scene& scene) {
    objects_.try_emplace(object.object, SeenObject{scene.stamp_ns});
    for (ErrorLists* lists :
         {&all_, &classes_[object.object_class], &bands_[band_of(object.world_from_object, scene)]})
      ++lists->rows;
  }

  void note_matched(const TrueObject& object, const ReportedTrack& track, const Scene& scene) {
    SeenObject& history = objects_.at(object.object);
    if (!history.is_detected)
      delays_s_.push_back(static_cast<double>(scene.stamp_ns - history.first_counted_ns) * 1e-9);
    history.is_detected = true;
    const bool is_sample =
        track.position_covariance_m2 && scene.stamp_ns - history.last_nees_ns >= kNeesIntervalNs;
    if (is_sample) history.last_nees_ns = scene.stamp_ns;
    for (ErrorLists* lists : {&all_, &classes_[object.object_class],
                              &bands_[band_of(object.world_from_object, scene)]}) {
      add(object, track, *lists);
      if (is_sample) lists->nees.push_back(position_nees(object, track));
    }
  }

  const std::vector<double>& starts_m_;
  double range_m_;
  ErrorLists all_;
  std::map<std::string, ErrorLists> classes_;
  std::vector<ErrorLists> bands_;
  std::vector<std::size_t> false_rows_;
  std::unordered_map<std::size_t, SeenObject> objects_;
  std::vector<double> delays_s_;
};

}  // namespace

bool is_same_class(const std::string& true_class, const std::string& reported_class) {
  if (reported_class == "truck_or_bus") return true_class == "truck" || true_class == "bus";
  return true_class == reported_class;
}

ObjectErrorTables object_errors(const std::vector<Scene>& scenes,
                                const std::vector<CountedScene>& counted, const ClearMot& matched,
                                const std::vector<double>& band_starts_m, double range_m) {
  Collector collector(band_starts_m, range_m);
  for (std::size_t i = 0; i < scenes.size(); ++i)
    collector.take(scenes[i], counted[i], matched.matches[i]);
  return collector.tables();
}

}  // namespace slammot::metrics
