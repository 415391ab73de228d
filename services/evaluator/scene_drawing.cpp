#include "services/evaluator/scene_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/files/text.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/report_picture.hpp"
#include "services/evaluator/stamps.hpp"
#include "services/evaluator/stroke_font.hpp"

namespace slammot::evaluator {
namespace {

using files::Rgb;
using geometry::Pose2;
using geometry::Vector2;

constexpr double kTrailS = 6.0;
constexpr double kArrowS = 1.0;  // of motion
constexpr double kArrowFromMps = 0.5;
constexpr double kVehicleLengthM = 4.2;
constexpr double kVehicleWidthM = 1.8;
constexpr double kMarginM = 5.0;

double smoothstep(double low, double high, double value) {
  const double part = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return part * part * (3.0 - 2.0 * part);
}

Rgb mixed(const Rgb& a, const Rgb& b, double part) {
  Rgb colour;
  for (std::size_t i = 0; i < 3; ++i)
    colour[i] = static_cast<std::uint8_t>(std::lround(a[i] + part * (b[i] - a[i])));
  return colour;
}

/// Colours of the indices of joined_maps(), as ground.js of the live page mixes them.
std::vector<Rgb> ground_palette(const PageTheme& theme) {
  constexpr double kOpacity = 0.8;  // of the MO-map
  const std::array<Rgb, 3> grounds = {theme.at("back"), theme.at("free"), theme.at("wall")};
  std::vector<Rgb> palette;
  for (int motion = 0; motion < kMotionLevels; ++motion) {
    const double share = static_cast<double>(motion) / (kMotionLevels - 1);
    const double strength = 0.75 * kOpacity * smoothstep(0.02, 0.6, share);
    for (std::size_t ground = 0; ground < grounds.size(); ++ground)
      palette.push_back(mixed(grounds[ground], theme.at("motion"), ground == 2 ? 0.0 : strength));
  }
  return palette;
}

Pose2 corrected_from_online(const RunResult& result, std::int64_t stamp_ns) {
  return pose_near(result.corrected, stamp_ns) *
         geometry::inverse(pose_near(result.online, stamp_ns));
}

}  // namespace

GroundView whole_view(const RunResult& result, double most_pixels) {
  Vector2 low_m = Vector2::Zero();
  Vector2 high_m = Vector2::Zero();
  if (!result.corrected.empty()) low_m = high_m = result.corrected.front().pose.translation_m();
  for (const metrics::StampedPose& pose : result.corrected) {
    low_m = low_m.cwiseMin(pose.pose.translation_m());
    high_m = high_m.cwiseMax(pose.pose.translation_m());
  }
  low_m -= Vector2::Constant(kMarginM);
  high_m += Vector2::Constant(kMarginM);
  if (result.map) {
    const files::MapImage& map = *result.map;
    low_m = {map.min_x_m, map.min_y_m};
    high_m = low_m + Vector2(map.width, map.height) * map.resolution_m;
  }
  const Vector2 size_m = high_m - low_m;
  const double metres_per_pixel = std::max(0.01, size_m.maxCoeff() / most_pixels);
  return {{low_m.x(), high_m.y()},
          metres_per_pixel,
          std::max(1.0, std::ceil(size_m.x() / metres_per_pixel)),
          std::max(1.0, std::ceil(size_m.y() / metres_per_pixel))};
}

SceneDrawing::SceneDrawing(const RunResult& result, const PageTheme& theme, double metres_per_pixel)
    : result_(result), theme_(theme) {
  if (!result.map || result.map->width == 0) return;
  const double pixels = std::max(1.0, std::round(metres_per_pixel / result.map->resolution_m));
  const auto step = static_cast<std::uint32_t>(std::min(pixels, 1e6));
  files::IndexedImage image =
      joined_maps(*result.map, result.moving ? &*result.moving : nullptr, step);
  image.palette = ground_palette(theme);
  pixel_of_map_m_ = result.map->resolution_m * step;
  map_ = std::make_shared<const files::IndexedImage>(std::move(image));
}

Rgb SceneDrawing::colour(const std::string& name) const {
  const auto known = theme_.find(name);
  return known == theme_.end() ? theme_.at("other") : known->second;
}

Drawing SceneDrawing::ground(const GroundView& view) const {
  Drawing drawing{view.width, view.height, colour("back"), {}};
  if (!map_) return drawing;
  const files::MapImage& map = *result_.map;
  const Vector2 corner_m{map.min_x_m, map.min_y_m + map.height * map.resolution_m};
  drawing.marks.emplace_back(ImageMark{map_, view.place(corner_m),
                                       map_->width * pixel_of_map_m_ / view.metres_per_pixel,
                                       map_->height * pixel_of_map_m_ / view.metres_per_pixel});
  return drawing;
}

void SceneDrawing::add_way(const GroundView& view, std::int64_t until_ns, Drawing& drawing) const {
  LineMark way{{}, {colour("way"), 0.9}, 2.0};
  for (const metrics::StampedPose& pose : result_.corrected) {
    if (pose.stamp_ns > until_ns) break;
    const PlotPoint at = view.place(pose.pose.translation_m());
    if (way.points.empty() ||
        std::hypot(at.x - way.points.back().x, at.y - way.points.back().y) >= 1.0)
      way.points.push_back(at);
  }
  drawing.marks.emplace_back(std::move(way));
}

void SceneDrawing::add_closures(const GroundView& view, Drawing& drawing) const {
  for (const GraphEdge& edge : result_.graph.edges) {
    if (!edge.is_loop || edge.state != "accepted") continue;
    const auto place = [&](std::uint64_t id) {
      return view.place(result_.graph.map_from_submap.at(id).translation_m());
    };
    drawing.marks.emplace_back(
        LineMark{{place(edge.from), place(edge.to)}, {colour("accepted"), 0.8}, 1.4});
  }
}

void SceneDrawing::add_paths(const GroundView& view, Drawing& drawing) const {
  std::map<std::uint32_t, std::pair<LineMark, std::string>> paths;
  for (const TracksAt& at : result_.tracks) {
    const Pose2 correction = corrected_from_online(result_, at.stamp_ns);
    for (const ResultTrack& track : at.tracks) {
      auto& [line, object_class] = paths[track.track_id];
      const PlotPoint place = view.place(correction * track.map_from_object.translation_m());
      object_class = track.object_class;
      if (line.points.empty() ||
          std::hypot(place.x - line.points.back().x, place.y - line.points.back().y) >= 1.0)
        line.points.push_back(place);
    }
  }
  for (auto& [id, path] : paths) {
    path.first.ink = {colour(colour_name_of(path.second)), 0.85};
    path.first.width = 1.3;
    drawing.marks.emplace_back(std::move(path.first));
  }
}

void SceneDrawing::add_box(const GroundView& view, const Pose2& pose, double length_m,
                           double width_m, const Rgb& box_colour, double opacity,
                           Drawing& drawing) const {
  std::vector<PlotPoint> corners;
  for (const auto& [along, across] : {std::pair(0.5, 0.5), {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}})
    corners.push_back(view.place(pose * Vector2{along * length_m, across * width_m}));
  drawing.marks.emplace_back(AreaMark{corners, {box_colour, 0.35 * opacity}});
  corners.push_back(corners.front());
  drawing.marks.emplace_back(LineMark{corners, {box_colour, opacity}, 1.5});
}

void SceneDrawing::add_track(const GroundView& view, const ResultTrack& track,
                             const Pose2& correction, Drawing& drawing) const {
  const Pose2 pose = correction * track.map_from_object;
  const Rgb own = colour(colour_name_of(track.object_class));
  add_box(view, pose, track.length_m, track.width_m, own, track.is_occluded ? 0.4 : 1.0, drawing);
  const Vector2 velocity_mps =
      geometry::rotation(correction.heading_rad) * track.velocity_in_map_mps;
  const PlotPoint from = view.place(pose.translation_m());
  if (velocity_mps.norm() >= kArrowFromMps) {
    const PlotPoint tip = view.place(pose.translation_m() + kArrowS * velocity_mps);
    drawing.marks.emplace_back(LineMark{{from, tip}, {colour("vehicle"), 0.9}, 1.5});
  }
}

/// Names beside tracks, the nearest to the vehicle first, and none over another.
void SceneDrawing::add_names(const GroundView& view, const TracksAt& at, Drawing& drawing) const {
  constexpr double kSize = 11.0;
  constexpr double kLine = 13.0;  // height with its margin
  std::vector<const ResultTrack*> tracks;
  for (const ResultTrack& track : at.tracks) tracks.push_back(&track);
  const Vector2 vehicle_m = pose_near(result_.online, at.stamp_ns).translation_m();
  std::ranges::sort(tracks, {}, [&](const ResultTrack* track) {
    return (track->map_from_object.translation_m() - vehicle_m).norm();
  });
  const Pose2 correction = corrected_from_online(result_, at.stamp_ns);
  std::vector<std::pair<PlotPoint, double>> taken;  // with widths
  for (const ResultTrack* track : tracks) {
    std::string name = track->object_class == "truck_or_bus" ? "truck or bus" : track->object_class;
    name.append(" ").append(std::to_string(track->track_id));
    if (track->is_moving)
      name += files::text("  %.0f km/h", 3.6 * track->velocity_in_map_mps.norm());
    const PlotPoint centre = view.place(correction * track->map_from_object.translation_m());
    const PlotPoint place{centre.x + 9.0, centre.y - 9.0};
    const double width = 0.7 * kSize * width_of(name);
    const bool is_free = std::ranges::none_of(taken, [&](const auto& other) {
      return std::abs(other.first.y - place.y) < kLine && place.x < other.first.x + other.second &&
             other.first.x < place.x + width;
    });
    if (!is_free) continue;
    taken.emplace_back(place, width);
    drawing.marks.emplace_back(
        TextMark{place, name, {colour(colour_name_of(track->object_class))}, kSize});
  }
}

void SceneDrawing::add_trails(const GroundView& view, std::int64_t stamp_ns,
                              Drawing& drawing) const {
  std::map<std::uint32_t, std::pair<LineMark, std::string>> trails;
  const auto begin = std::ranges::lower_bound(
      result_.tracks, stamp_ns - static_cast<std::int64_t>(kTrailS * 1e9), {}, &TracksAt::stamp_ns);
  for (auto at = begin; at != result_.tracks.end() && at->stamp_ns <= stamp_ns; ++at) {
    const Pose2 correction = corrected_from_online(result_, at->stamp_ns);
    for (const ResultTrack& track : at->tracks) {
      auto& [line, object_class] = trails[track.track_id];
      line.points.push_back(view.place(correction * track.map_from_object.translation_m()));
      object_class = track.object_class;
    }
  }
  for (auto& [id, trail] : trails) {
    trail.first.ink = {colour(colour_name_of(trail.second)), 0.5};
    trail.first.width = 2.0;
    drawing.marks.emplace_back(std::move(trail.first));
  }
}

void SceneDrawing::add_tracks(const GroundView& view, std::int64_t stamp_ns,
                              Drawing& drawing) const {
  constexpr std::int64_t kNearNs = 200'000'000;
  const TracksAt* const at = at_stamp(result_.tracks, stamp_ns, kNearNs);
  if (at == nullptr) return;
  add_trails(view, at->stamp_ns, drawing);
  const Pose2 correction = corrected_from_online(result_, at->stamp_ns);
  for (const ResultTrack& track : at->tracks) add_track(view, track, correction, drawing);
  add_names(view, *at, drawing);
}

void SceneDrawing::add_vehicle(const GroundView& view, std::int64_t stamp_ns,
                               Drawing& drawing) const {
  const Pose2 pose = pose_near(result_.corrected, stamp_ns);
  add_box(view, pose, kVehicleLengthM, kVehicleWidthM, colour("vehicle"), 1.0, drawing);
  const auto at = [&](double ahead_m, double left_m) {
    return view.place(pose * Vector2{ahead_m, left_m});
  };
  drawing.marks.emplace_back(
      LineMark{{at(-0.3, 0.65), at(1.4, 0.0), at(-0.3, -0.65)}, {colour("vehicle"), 1.0}, 1.8});
}

void SceneDrawing::add_scale(const GroundView& view, Drawing& drawing) const {
  const double most_m = 0.25 * view.width * view.metres_per_pixel;
  const double power = std::pow(10.0, std::floor(std::log10(most_m)));
  const double length_m = power * (most_m >= 5.0 * power ? 5.0 : most_m >= 2.0 * power ? 2.0 : 1.0);
  const double right = view.width - 14.0;
  const double left = right - length_m / view.metres_per_pixel;
  const double base = view.height - 12.0;
  const Ink ink{colour("vehicle"), 0.8};
  drawing.marks.emplace_back(
      LineMark{{{left, base - 5.0}, {left, base}, {right, base}, {right, base - 5.0}}, ink, 1.5});
  drawing.marks.emplace_back(TextMark{
      {0.5 * (left + right), base - 6.0}, svg_number(length_m) + " m", ink, 11.0, Anchor::kMiddle});
}

}  // namespace slammot::evaluator
