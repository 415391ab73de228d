#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "services/evaluator/figures.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// The y axis of SVG points down.
std::string place(const Vector2& point_in_map_m) {
  return svg_number(point_in_map_m.x()) + " " + svg_number(-point_in_map_m.y());
}

/// SVG path of points in map; points nearer than a step to the last one are left out.
class PathText {
 public:
  explicit PathText(double step_m) : step_m_(step_m) {}

  void go_to(const Vector2& point_m) {
    if (!text_.empty() && (point_m - last_m_).norm() < step_m_) return;
    text_.append(1, text_.empty() ? 'M' : 'L').append(place(point_m));
    last_m_ = point_m;
  }
  const std::string& text() const { return text_; }

 private:
  double step_m_;
  std::string text_;
  Vector2 last_m_ = Vector2::Zero();
};

std::string path(const std::string& d, const std::string& colour, const char* kind,
                 const std::string& title) {
  return "<path class=\"" + std::string(kind) + "\" stroke=\"" + colour + "\" d=\"" + d +
         "\"><title>" + escaped(title) + "</title></path>";
}

std::string trajectory_path(const metrics::Trajectory& trajectory, const Pose2& map_from_frame,
                            double step_m, const char* colour, const char* kind,
                            const char* title) {
  PathText text(step_m);
  for (const metrics::StampedPose& pose : trajectory)
    text.go_to(map_from_frame * pose.pose.translation_m());
  return path(text.text(), colour, kind, title);
}

struct DrawnTrack {
  PathText path;
  std::string object_class;  // as published last
};

/// Paths of tracks relative to the corrected poses, consistent with the map.
std::map<std::uint32_t, DrawnTrack> drawn_tracks(const RunResult& result, double step_m) {
  std::map<std::uint32_t, DrawnTrack> drawn;
  for (const TracksAt& at : result.tracks) {
    const Pose2 corrected_from_online = pose_near(result.corrected, at.stamp_ns) *
                                        geometry::inverse(pose_near(result.online, at.stamp_ns));
    for (const ResultTrack& track : at.tracks) {
      DrawnTrack& one =
          drawn.try_emplace(track.track_id, DrawnTrack{PathText(step_m), {}}).first->second;
      one.path.go_to(corrected_from_online * track.map_from_object.translation_m());
      one.object_class = track.object_class;
    }
  }
  return drawn;
}

struct Frame {
  Vector2 low_m = Vector2::Zero();
  Vector2 high_m = Vector2::Ones();
};

/// Bounds of the map if there is one, otherwise of the trajectory.
Frame frame_of(const RunResult& result) {
  if (result.map) {
    const files::MapImage& map = *result.map;
    const Vector2 low_m{map.min_x_m, map.min_y_m};
    return {low_m, low_m + Vector2(map.width, map.height) * map.resolution_m};
  }
  Frame frame{result.corrected.front().pose.translation_m(),
              result.corrected.front().pose.translation_m()};
  for (const metrics::StampedPose& pose : result.corrected) {
    frame.low_m = frame.low_m.cwiseMin(pose.pose.translation_m());
    frame.high_m = frame.high_m.cwiseMax(pose.pose.translation_m());
  }
  return {frame.low_m - Vector2::Constant(5.0), frame.high_m + Vector2::Constant(5.0)};
}

std::string class_legend(const std::set<std::string>& classes, bool has_truth) {
  std::string html =
      "<p class=\"legend\"><span><i style=\"background:#1f5fa8\"></i>trajectory after the last "
      "correction</span>"
      "<span><i style=\"background:#e0a100\"></i>as published live</span>";
  if (has_truth) html += "<span><i style=\"background:#111\"></i>true trajectory (dotted)</span>";
  for (const std::string& name : classes)
    html += "<span><i style=\"background:" + std::string(colour_of(name)) +
            "\"></i>track: " + escaped(name) + "</span>";
  return html + "</p>";
}

}  // namespace

const char* colour_of(const std::string& object_class) {
  if (object_class == "pedestrian") return "#c2185b";
  if (object_class == "bicycle") return "#2e8b57";
  if (object_class == "car") return "#d9480f";
  if (object_class == "truck_or_bus") return "#6f42c1";
  return "#7a7a7a";
}

Pose2 pose_near(const metrics::Trajectory& trajectory, std::int64_t stamp_ns) {
  if (trajectory.empty()) return Pose2::identity();
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), stamp_ns,
                       [](const auto& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  if (after == trajectory.end()) return trajectory.back().pose;
  const bool is_before_nearer = after != trajectory.begin() &&
                                stamp_ns - std::prev(after)->stamp_ns < after->stamp_ns - stamp_ns;
  return is_before_nearer ? std::prev(after)->pose : after->pose;
}

std::string map_figure(const ReportSource& source) {
  const RunResult& result = *source.result;
  const Frame frame = frame_of(result);
  const Vector2 size_m = frame.high_m - frame.low_m;
  const double step_m = size_m.maxCoeff() / 1000.0;  // about a pixel
  std::string svg = "<svg class=\"map\" viewBox=\"" + place({frame.low_m.x(), frame.high_m.y()}) +
                    " " + svg_number(size_m.x()) + " " + svg_number(size_m.y()) +
                    "\" role=\"img\">";
  if (result.map && !source.map_png.empty()) {
    svg += "<image x=\"" + svg_number(frame.low_m.x()) + "\" y=\"" + svg_number(-frame.high_m.y()) +
           "\" width=\"" + svg_number(size_m.x()) + "\" height=\"" + svg_number(size_m.y()) +
           "\" href=\"data:image/png;base64," + to_base64(source.map_png) + "\"/>";
  }
  std::set<std::string> classes;
  for (const auto& [id, track] : drawn_tracks(result, step_m)) {
    svg += path(track.path.text(), colour_of(track.object_class), "track",
                "track " + std::to_string(id) + ", " + track.object_class);
    classes.insert(track.object_class);
  }
  svg += trajectory_path(result.online, Pose2::identity(), step_m, "#e0a100", "thin",
                         "as published live");
  svg += trajectory_path(result.corrected, Pose2::identity(), step_m, "#1f5fa8", "way",
                         "after the last correction");
  if (source.truth && source.evaluation) {
    svg += trajectory_path(source.truth->trajectory,
                           geometry::inverse(source.evaluation->corrected.world_from_map), step_m,
                           "#111", "dotted", "true trajectory");
  }
  svg += "</svg>";
  return "<section><h2>Map, trajectory and tracks</h2><figure>" + svg +
         class_legend(classes, source.truth != nullptr) +
         "<figcaption>Stationary objects are black, free space is white; " +
         svg_number(std::round(size_m.x())) + " m by " + svg_number(std::round(size_m.y())) +
         " m. Tracks are drawn relative to the corrected poses of the "
         "vehicle.</figcaption></figure></section>";
}

}  // namespace slammot::evaluator
