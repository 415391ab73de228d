#include "common/metrics/published_rows.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace slammot::metrics {
namespace {

/// Objects last covered by each track, up to the present scan.
class Owners {
 public:
  explicit Owners(const Timelines& timelines) {
    for (const auto& [object, timeline] : timelines) {
      for (const CoveredMoment& moment : timeline) {
        if (moment.track) covered_[{moment.scan, *moment.track}] = object;
      }
    }
  }

  void advance(std::size_t scan, const Scene& scene) {
    for (const ReportedTrack& track : scene.tracks) {
      if (const auto covered = covered_.find({scan, track.track}); covered != covered_.end())
        object_of_[track.track] = covered->second;
    }
  }

  std::optional<std::size_t> of(std::size_t track) const {
    const auto known = object_of_.find(track);
    return known == object_of_.end() ? std::nullopt : std::optional(known->second);
  }

 private:
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> covered_;  // by scan and track
  std::map<std::size_t, std::size_t> object_of_;
};

void count_occluded(const Scene& scene, const Owners& owners, const CountingRule& rule,
                    OccludedRows& counts) {
  const std::vector<const TrueObject*> objects = all_objects(scene);
  for (const ReportedTrack& track : scene.occluded_tracks) {
    bool is_at_own = false;
    bool is_at_any = false;
    for (const TrueObject* object : objects) {
      if (!is_at(track, *object, rule)) continue;
      is_at_any = true;
      is_at_own = is_at_own || owners.of(track.track) == object->object;
    }
    ++(is_at_own ? counts.at_own_object : is_at_any ? counts.at_other_object : counts.at_nothing);
  }
}

/// A track's last row so far.
struct LastRow {
  std::size_t scan = 0;
  std::optional<std::size_t> object;  ///< That the track covers, or covered last.
};

void count_gap(const std::vector<Scene>& scenes, const LastRow& last, const LastRow& now,
               PublicationGaps& counts) {
  const std::size_t missing = now.scan - last.scan - 1;
  if (missing == 0) return;
  ++counts.gaps;
  counts.missing_rows += missing;
  if (!last.object || last.object != now.object) return;
  ++counts.gaps_on_object;
  std::size_t in_view = 0;
  for (std::size_t i = last.scan + 1; i < now.scan; ++i) {
    const auto object = std::ranges::find(scenes[i].objects, *last.object, &TrueObject::object);
    in_view += object != scenes[i].objects.end() && object->points > 0 ? 1 : 0;
  }
  if (2 * in_view <= missing) return;
  ++counts.gaps_in_view;
  counts.missing_rows_in_view += missing;
}

}  // namespace

double OccludedRows::precision() const {
  return rows() == 0 ? 0.0 : static_cast<double>(at_own_object) / static_cast<double>(rows());
}

PublishedRows published_rows(const std::vector<Scene>& scenes, const Timelines& timelines,
                             const CountingRule& rule) {
  PublishedRows published;
  Owners owners(timelines);
  std::map<std::size_t, LastRow> last_rows;
  for (std::size_t scan = 0; scan < scenes.size(); ++scan) {
    owners.advance(scan, scenes[scan]);
    count_occluded(scenes[scan], owners, rule, published.occluded);
    for (const auto* rows : {&scenes[scan].tracks, &scenes[scan].occluded_tracks}) {
      for (const ReportedTrack& track : *rows) {
        const LastRow now{scan, owners.of(track.track)};
        if (const auto last = last_rows.find(track.track); last != last_rows.end())
          count_gap(scenes, last->second, now, published.gaps);
        last_rows[track.track] = now;
      }
    }
  }
  return published;
}

}  // namespace slammot::metrics
