#pragma once

#include <cstdint>

#include "services/evaluator/drawing.hpp"
#include "services/evaluator/page_theme.hpp"
#include "services/evaluator/result_files.hpp"

namespace slammot::evaluator {

/// The part of the ground that a picture shows; north up.
struct GroundView {
  geometry::Vector2 upper_left_m = geometry::Vector2::Zero();  ///< In map.
  double metres_per_pixel = 0.1;
  double width = 640.0;  ///< [pixels]
  double height = 400.0;

  PlotPoint place(const geometry::Vector2& point_in_map_m) const {
    return {(point_in_map_m.x() - upper_left_m.x()) / metres_per_pixel,
            (upper_left_m.y() - point_in_map_m.y()) / metres_per_pixel};
  }
};

/// A view of the whole map, or of the trajectory where there is none, in at most so many pixels
/// along its longer side.
GroundView whole_view(const RunResult& result, double most_pixels);

/// Draws a result in the colours of the live page, all at the poses after the last correction.
class SceneDrawing {
 public:
  /// `result` must outlive it.
  SceneDrawing(const RunResult& result, const PageTheme& theme, double metres_per_pixel);

  /// Maps on the ground; the beginning of a picture.
  Drawing ground(const GroundView& view) const;

  void add_way(const GroundView& view, std::int64_t until_ns, Drawing& drawing) const;
  void add_closures(const GroundView& view, Drawing& drawing) const;

  /// Paths of all tracks of the drive.
  void add_paths(const GroundView& view, Drawing& drawing) const;

  /// Tracks in the scan nearest to the stamp: box, speed, path of the last seconds and name.
  void add_tracks(const GroundView& view, std::int64_t stamp_ns, Drawing& drawing) const;

  void add_vehicle(const GroundView& view, std::int64_t stamp_ns, Drawing& drawing) const;

  /// A bar of a round length in the lower right corner.
  void add_scale(const GroundView& view, Drawing& drawing) const;

  files::Rgb colour(const std::string& name) const;

 private:
  void add_box(const GroundView& view, const geometry::Pose2& pose, double length_m, double width_m,
               const files::Rgb& colour, double opacity, Drawing& drawing) const;
  void add_track(const GroundView& view, const ResultTrack& track,
                 const geometry::Pose2& corrected_from_online, Drawing& drawing) const;
  void add_names(const GroundView& view, const TracksAt& at, Drawing& drawing) const;
  void add_trails(const GroundView& view, std::int64_t stamp_ns, Drawing& drawing) const;

  const RunResult& result_;
  PageTheme theme_;
  std::shared_ptr<const files::IndexedImage> map_;
  double pixel_of_map_m_ = 0.0;
};

}  // namespace slammot::evaluator
