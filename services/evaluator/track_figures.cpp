#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "services/evaluator/figures.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kReportGapS = 0.5;  // Longer gaps between reports interrupt the line.
const std::array<const char*, 6> kModeColours = {"#1f5fa8", "#d9480f", "#2e8b57",
                                                 "#6f42c1", "#e0a100", "#7a7a7a"};

using TrackRows = std::vector<const ResultTrack*>;

std::map<std::uint32_t, TrackRows> rows_by_track(const RunResult& result) {
  std::map<std::uint32_t, TrackRows> rows;
  for (const TracksAt& at : result.tracks) {
    for (const ResultTrack& track : at.tracks) rows[track.track_id].push_back(&track);
  }
  return rows;
}

std::size_t turns_of_motion(const TrackRows& rows) {
  std::size_t turns = 0;
  for (std::size_t i = 1; i < rows.size(); ++i)
    turns += rows[i]->is_moving != rows[i - 1]->is_moving ? 1 : 0;
  return turns;
}

/// The true object nearest to the track, within the gate, in most scans; empty without truth.
std::optional<std::size_t> object_of(const Evaluation& evaluation, std::uint32_t track_id) {
  constexpr double kGateM = 2.0;
  const auto known = std::find(evaluation.track_ids.begin(), evaluation.track_ids.end(), track_id);
  if (known == evaluation.track_ids.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(known - evaluation.track_ids.begin());
  std::map<std::size_t, std::size_t> votes;
  for (const metrics::Scene& scene : evaluation.scenes) {
    for (const metrics::ReportedTrack& track : scene.tracks) {
      if (track.track != index || scene.objects.empty()) continue;
      const auto away_m = [&](const metrics::TrueObject& object) {
        return metrics::distance_to_box_m(track.world_from_object.translation_m(), object);
      };
      const auto nearest =
          std::min_element(scene.objects.begin(), scene.objects.end(),
                           [&](const auto& a, const auto& b) { return away_m(a) < away_m(b); });
      if (away_m(*nearest) <= kGateM) ++votes[nearest->object];
    }
  }
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? std::nullopt : std::optional(most->first);
}

struct TrueCourse {
  Series speed{"true speed", "#111", {}, kReportGapS, true};
  std::string object_class;
};

TrueCourse true_course(const Evaluation& evaluation, std::size_t object, std::int64_t begin_ns,
                       std::int64_t end_ns, std::int64_t zero_ns) {
  TrueCourse course;
  for (const metrics::Scene& scene : evaluation.scenes) {
    if (scene.stamp_ns < begin_ns || scene.stamp_ns > end_ns) continue;
    for (const metrics::TrueObject& one : scene.objects) {
      if (one.object != object) continue;
      course.speed.points.push_back(
          {static_cast<double>(scene.stamp_ns - zero_ns) * 1e-9, std::abs(one.speed_mps)});
      course.object_class = one.object_class;
    }
  }
  return course;
}

std::vector<Span> standing(const TrackRows& rows, std::int64_t zero_ns) {
  std::vector<Span> spans;
  const auto at_s = [&](const ResultTrack* row) {
    return static_cast<double>(row->stamp_ns - zero_ns) * 1e-9;
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i]->is_moving) continue;
    const double to_s = i + 1 < rows.size() && at_s(rows[i + 1]) - at_s(rows[i]) < kReportGapS
                            ? at_s(rows[i + 1])
                            : at_s(rows[i]);
    if (!spans.empty() && at_s(rows[i]) <= spans.back().to + 1e-9) spans.back().to = to_s;
    else spans.push_back({at_s(rows[i]), to_s});
  }
  return spans;
}

std::string speed_figure(const TrackRows& rows, const std::optional<TrueCourse>& truth,
                         const std::vector<Span>& shaded, std::int64_t zero_ns) {
  Series speed{"estimated speed", "#1f5fa8", {}, kReportGapS};
  for (const ResultTrack* row : rows)
    speed.points.push_back(
        {static_cast<double>(row->stamp_ns - zero_ns) * 1e-9, row->velocity_in_map_mps.norm()});
  Plot plot{"time [s]", "speed [m/s]", {speed}, shaded, {}, 200.0};
  if (truth) plot.series.insert(plot.series.begin(), truth->speed);
  return to_svg(plot);
}

std::string mode_figure(const TrackRows& rows, const std::vector<Span>& shaded,
                        std::int64_t zero_ns) {
  const std::size_t modes = rows.front()->mode_probability.size();
  if (modes == 0) return {};
  const std::array<const char*, 3> names = {"constant velocity", "constant acceleration",
                                            "coordinated turn"};
  Plot plot{"time [s]", "mode probability", {}, shaded, 1.0, 170.0};
  for (std::size_t mode = 0; mode < modes; ++mode) {
    Series series{mode < names.size() ? names[mode] : "model " + std::to_string(mode),
                  kModeColours[mode % kModeColours.size()],
                  {},
                  kReportGapS};
    bool is_used = false;
    for (const ResultTrack* row : rows) {
      if (row->mode_probability.size() != modes) continue;
      series.points.push_back(
          {static_cast<double>(row->stamp_ns - zero_ns) * 1e-9, row->mode_probability[mode]});
      is_used = is_used || row->mode_probability[mode] > 0.0;
    }
    if (is_used) plot.series.push_back(std::move(series));
  }
  return plot.series.empty() ? "" : to_svg(plot);
}

std::string one_track(const ReportSource& source, std::uint32_t track_id, const TrackRows& rows) {
  const std::int64_t zero_ns = source.result->online.front().stamp_ns;
  std::optional<TrueCourse> truth;
  if (source.evaluation) {
    if (const auto object = object_of(*source.evaluation, track_id))
      truth = true_course(*source.evaluation, *object, rows.front()->stamp_ns,
                          rows.back()->stamp_ns, zero_ns);
  }
  const std::vector<Span> shaded = standing(rows, zero_ns);
  std::string caption =
      "Track " + std::to_string(track_id) + ", " + rows.back()->object_class + ", " +
      svg_number(std::round(rows.back()->length_m * 10.0) / 10.0) + " m by " +
      svg_number(std::round(rows.back()->width_m * 10.0) / 10.0) + " m, tracked for " +
      svg_number(
          std::round(static_cast<double>(rows.back()->stamp_ns - rows.front()->stamp_ns) * 1e-8) /
          10.0) +
      " s";
  if (truth) caption += "; true class: " + truth->object_class;
  if (!shaded.empty()) caption += "; shaded: stationary";
  return "<figure>" + speed_figure(rows, truth, shaded, zero_ns) +
         mode_figure(rows, shaded, zero_ns) + "<figcaption>" + escaped(caption) +
         ".</figcaption></figure>";
}

}  // namespace

std::vector<std::uint32_t> choose_tracks(const RunResult& result) {
  constexpr std::size_t kOfEach = 2;
  std::map<std::string, std::vector<std::pair<std::size_t, std::uint32_t>>> by_length_of_class;
  std::vector<std::pair<std::size_t, std::uint32_t>> by_turns;
  for (const auto& [id, rows] : rows_by_track(result)) {
    by_length_of_class[rows.back()->object_class].emplace_back(rows.size(), id);
    if (const std::size_t turns = turns_of_motion(rows)) by_turns.emplace_back(turns, id);
  }
  std::vector<std::uint32_t> chosen;
  const auto take = [&](std::vector<std::pair<std::size_t, std::uint32_t>> candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    std::size_t taken = 0;
    for (const auto& [score, id] : candidates) {
      if (taken == kOfEach) break;
      if (std::find(chosen.begin(), chosen.end(), id) != chosen.end()) continue;
      chosen.push_back(id);
      ++taken;
    }
  };
  for (const auto& [name, candidates] : by_length_of_class) {
    if (name != "unknown") take(candidates);
  }
  take(by_turns);
  return chosen;
}

std::string track_figures(const ReportSource& source) {
  const auto rows = rows_by_track(*source.result);
  const std::vector<std::uint32_t> ids =
      source.track_ids.empty() ? choose_tracks(*source.result) : source.track_ids;
  std::string html;
  for (const std::uint32_t id : ids) {
    if (const auto known = rows.find(id); known != rows.end())
      html += one_track(source, id, known->second);
  }
  return html.empty() ? html : "<section><h2>Single tracks</h2>" + html + "</section>";
}

}  // namespace slammot::evaluator
