#include "common/metrics/occlusion.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>

#include "common/metrics/chi_square.hpp"
#include "common/metrics/coverage.hpp"
#include "common/metrics/share.hpp"

namespace slammot::metrics {
namespace {

using geometry::Vector2;

/// A track may need this long to cover an object that is seen again, and may have lost an object
/// this long before it is hidden.
constexpr double kPatienceS = 1.0;
constexpr double kFirstSampleS = 0.5;  // after the object was seen last
constexpr double kSampleIntervalS = 1.0;

using Timeline = std::vector<CoveredMoment>;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

const ReportedTrack* row_of(const std::vector<ReportedTrack>& tracks, std::size_t track) {
  const auto row = std::ranges::find(tracks, track, &ReportedTrack::track);
  return row == tracks.end() ? nullptr : &*row;
}

/// Two sightings of an object with enough echoes; most of the scans between them have none.
struct Occlusion {
  std::size_t last_seen = 0;           ///< Index in the timeline.
  std::optional<std::size_t> returns;  ///< None if it is not seen again.
  std::size_t track = 0;               ///< That covered the object last.
};

/// What the own tracks did while their objects were hidden.
struct HiddenErrors {
  std::vector<double> position_m;
  std::vector<double> nees;
};

/// Occlusions of one object.
class ObjectJudge {
 public:
  ObjectJudge(const std::vector<Scene>& scenes, const Timeline& timeline, const CountingRule& rule)
      : scenes_(scenes), timeline_(timeline), rule_(rule) {}

  void judge(OcclusionFigures& figures, HiddenErrors& errors) const {
    std::optional<Occlusion> undecided;  // no track covered the object between two occlusions
    std::optional<std::size_t> last_seen;
    for (std::size_t i = 0; i < timeline_.size(); ++i) {
      if (!is_seen(i)) continue;
      if (last_seen && is_occluded_between(*last_seen, i)) {
        const auto covered = covered_before(*last_seen);
        std::optional<Occlusion> occlusion = undecided;
        if (covered && (!undecided || *covered >= *undecided->returns))
          occlusion = Occlusion{*last_seen, i, *timeline_[*covered].track};
        if (occlusion) {
          occlusion->returns = i;
          undecided = settle(*occlusion, figures, errors) ? std::nullopt : occlusion;
        }
      }
      last_seen = i;
    }
    if (!last_seen) return;
    if (const auto covered = covered_before(*last_seen))
      measure({*last_seen, std::nullopt, *timeline_[*covered].track}, nullptr, errors);
  }

 private:
  const Scene& scene(std::size_t index) const { return scenes_[timeline_[index].scan]; }
  double between_s(std::size_t from, std::size_t to) const {
    return seconds(scene(to).stamp_ns - scene(from).stamp_ns);
  }

  bool is_seen(std::size_t index) const {
    const TrueObject& truth = *timeline_[index].truth;
    return truth.points >= rule_.least_points &&
           is_in_view(truth.world_from_object, scene(index), rule_);
  }

  bool is_occluded_between(std::size_t from, std::size_t to) const {
    const std::size_t scans = timeline_[to].scan - timeline_[from].scan - 1;
    const auto with_echoes = static_cast<std::size_t>(
        std::count_if(timeline_.begin() + static_cast<std::ptrdiff_t>(from) + 1,
                      timeline_.begin() + static_cast<std::ptrdiff_t>(to),
                      [](const CoveredMoment& moment) { return moment.truth->points > 0; }));
    return 2 * (scans - with_echoes) > scans;
  }

  /// When a track covered the object last in the second before.
  std::optional<std::size_t> covered_before(std::size_t last_seen) const {
    for (std::size_t i = last_seen + 1; i-- > 0 && between_s(i, last_seen) <= kPatienceS;) {
      if (timeline_[i].track) return i;
    }
    return std::nullopt;
  }

  struct After {
    std::optional<std::size_t> track;  ///< The first that covers the object again.
    bool is_due = false;               ///< The object counts in most scans of the time allowed.
  };

  After after(std::size_t returns) const {
    std::size_t counted = 0;
    for (std::size_t i = returns; i < timeline_.size() && between_s(returns, i) <= kPatienceS;
         ++i) {
      if (timeline_[i].track) return {timeline_[i].track, true};
      counted += does_count(*timeline_[i].truth, scene(i), rule_) ? 1 : 0;
    }
    std::size_t scans = 0;
    const std::size_t first = timeline_[returns].scan;
    while (first + scans < scenes_.size() &&
           seconds(scenes_[first + scans].stamp_ns - scenes_[first].stamp_ns) <= kPatienceS)
      ++scans;
    return {std::nullopt, 2 * counted > scans};
  }

  /// From the first scan without an echo to the first with one after the last without. [s]
  double hidden_s(const Occlusion& occlusion) const {
    std::size_t from = occlusion.last_seen;
    while (is_next_scan(from + 1) && has_echo(from + 1)) ++from;
    std::size_t to = *occlusion.returns;
    while (is_next_scan(to) && has_echo(to - 1)) --to;
    const std::size_t first_hidden = timeline_[from].scan + 1;
    return seconds(scene(to).stamp_ns - scenes_[first_hidden].stamp_ns);
  }

  /// True if the moment follows the one before without a scan between.
  bool is_next_scan(std::size_t index) const {
    return timeline_[index].scan == timeline_[index - 1].scan + 1;
  }
  bool has_echo(std::size_t index) const { return timeline_[index].truth->points > 0; }

  /// True if the occlusion is decided.
  bool settle(const Occlusion& occlusion, OcclusionFigures& figures, HiddenErrors& errors) const {
    const After next = after(*occlusion.returns);
    if (!next.is_due) return false;
    const double length_s = hidden_s(occlusion);
    const auto band = std::ranges::find_if(figures.by_length, [&](const OcclusionBand& candidate) {
      return length_s >= candidate.from_s && length_s < candidate.to_s;
    });
    if (band == figures.by_length.end()) return true;
    ++band->occlusions;
    band->kept += next.track == occlusion.track ? 1 : 0;
    measure(occlusion, &*band, errors);
    return true;
  }

  /// True if an object that has echoes is nearer to the track than the one of this timeline, which
  /// has none: the track follows that one.
  bool is_at_another(const ReportedTrack& track, std::size_t index) const {
    const auto distance_m = [&](const TrueObject& object) {
      return (object.world_from_object.translation_m() - track.world_from_object.translation_m())
          .norm();
    };
    const double to_own_m = distance_m(*timeline_[index].truth);
    return std::ranges::any_of(scene(index).objects, [&](const TrueObject& other) {
      return other.points > 0 && distance_m(other) < to_own_m;
    });
  }

  /// Coverage and errors in the scans without an echo.
  void measure(const Occlusion& occlusion, OcclusionBand* band, HiddenErrors& errors) const {
    double next_sample_s = kFirstSampleS;
    bool has_gone = false;
    const std::size_t end = occlusion.returns.value_or(timeline_.size());
    for (std::size_t i = occlusion.last_seen + 1; i < end; ++i) {
      const TrueObject& truth = *timeline_[i].truth;
      if (truth.points > 0) continue;
      const ReportedTrack* const predicted = row_of(scene(i).occluded_tracks, occlusion.track);
      const ReportedTrack* const own =
          predicted ? predicted : row_of(scene(i).tracks, occlusion.track);
      const bool is_covered = own && is_at(*own, truth, rule_);
      if (band) ++band->hidden_rows;
      if (band && is_covered) ++band->covered_rows;
      has_gone = has_gone || (own && !predicted && (!is_covered || is_at_another(*own, i)));
      if (has_gone || !own) continue;
      const Vector2 error_m =
          own->world_from_object.translation_m() - truth.world_from_object.translation_m();
      errors.position_m.push_back(error_m.norm());
      const double hidden_s = between_s(occlusion.last_seen, i);
      if (hidden_s < next_sample_s || !own->position_covariance_m2) continue;
      errors.nees.push_back(error_m.dot(own->position_covariance_m2->ldlt().solve(error_m)));
      next_sample_s = hidden_s + kSampleIntervalS;
    }
  }

  const std::vector<Scene>& scenes_;
  const Timeline& timeline_;
  const CountingRule& rule_;
};

}  // namespace

double OcclusionBand::kept_share() const { return share(kept, occlusions); }
double OcclusionBand::covered_share() const { return share(covered_rows, hidden_rows); }

OcclusionFigures occlusion_figures(const std::vector<Scene>& scenes, const CountingRule& rule) {
  constexpr double kEllipse = 0.95;
  const Timelines timelines = covered_timelines(scenes, rule);
  OcclusionFigures figures;
  HiddenErrors errors;
  for (const auto& [object, timeline] : timelines)
    ObjectJudge(scenes, timeline, rule).judge(figures, errors);
  const double limit = chi_square_quantile(kEllipse, 2.0);
  figures.inside_share = share(static_cast<std::size_t>(std::ranges::count_if(
                                   errors.nees, [&](double nees) { return nees <= limit; })),
                               errors.nees.size());
  figures.position_m = summarize(std::move(errors.position_m));
  figures.position_nees = summarize_nees(errors.nees, 2);
  figures.published = published_rows(scenes, timelines, rule);
  return figures;
}

}  // namespace slammot::metrics
