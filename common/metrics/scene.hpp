#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/metrics/matching.hpp"

namespace slammot::metrics {

/// Ground truth of an object at the time of one scan.
struct TrueObject {
  std::size_t object = 0;  ///< Index in the drive.
  std::string object_class;
  geometry::Pose2 world_from_object;  ///< Centre of its box, x along its length.
  double speed_mps = 0.0;             ///< Along its heading.
  double length_m = 0.0;
  double width_m = 0.0;
  int points = 0;             ///< Number of its echoes in this scan; 0 if occluded.
  double outline_seen = 0.0;  ///< Share of its outline that had an echo so far; 0 if unknown.
};

/// Predicted position of a track, in the frame of its owner.
struct PredictedPlace {
  double after_s = 0.0;
  geometry::Vector2 position_m = geometry::Vector2::Zero();
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();
};

/// A track as reported for one scan, transformed to the world's frame.
struct ReportedTrack {
  std::size_t track = 0;  ///< Index in the drive.
  std::string object_class;
  geometry::Pose2 world_from_object;
  geometry::Vector2 velocity_in_world_mps = geometry::Vector2::Zero();
  double length_m = 0.0;
  double width_m = 0.0;
  bool is_moving = true;                                    ///< As reported.
  std::optional<geometry::Matrix2> position_covariance_m2;  ///< In world.
  std::vector<PredictedPlace> predicted = {};               ///< In world.
};

struct Scene {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 world_from_base;
  std::vector<TrueObject> objects;
  std::vector<ReportedTrack> tracks;
  std::vector<TrueObject> hidden_objects = {};      ///< True objects without an echo,
  std::vector<ReportedTrack> occluded_tracks = {};  ///< and tracks reported as occluded: judged by
                                                    ///< occlusion_figures() only.
};

/// Which objects count, and matching thresholds; reasons are in docs/evaluation.md.
struct CountingRule {
  double range_m = 50.0;  ///< Objects beyond this distance from the vehicle do not count,
  double first_bearing_rad = -std::numbers::pi;  ///< nor those outside these bearings from the
                                                 ///< vehicle's axis,
  double last_bearing_rad = std::numbers::pi;    ///< to which the truth may be limited,
  double least_speed_mps = 0.5;                  ///< nor do slower ones,
  int least_points = 3;                          ///< nor those with fewer echoes.
  double dont_care_margin_m = 1.0;  ///< A track this near to the box of an uncounted object is
                                    ///< don't care.
  double gate_m = 2.0;  ///< From a track's position to the true box: farther is no match.
  double similarity_reach_m = 4.0;  ///< Similarity is max(0, 1 - distance / this).
};

/// The counted part of a scene.
struct CountedScene {
  MotFrame frame;
  std::vector<std::size_t> objects;  ///< Index in Scene::objects of each row,
  std::vector<std::size_t> tracks;   ///< and in Scene::tracks of each column.
  Eigen::MatrixXd distance_m;        ///< From the track's position to the object's box.
};

/// From the point to the object's box; 0 inside. [m]
double distance_to_box_m(const geometry::Vector2& point_in_world_m, const TrueObject& object);

/// True if the centre is within the rule's range and bearings.
bool is_in_view(const geometry::Pose2& world_from_object, const Scene& scene,
                const CountingRule& rule);

/// True if the object counts in this scene.
bool does_count(const TrueObject& object, const Scene& scene, const CountingRule& rule);

/// Adds occluded objects: in gaps of at most longest_gap_ns an object is interpolated, with no
/// points, so that a track through an occlusion has a match. Scenes ascend in time.
std::vector<Scene> fill_gaps(std::vector<Scene> scenes, std::int64_t longest_gap_ns);

/// Pairs all objects, including uncounted ones, with tracks by similarity. A track is ignored if
/// its partner does not count. A track without partner is ignored within the margin of an uncounted
/// object, or outside the counted range or bearings.
CountedScene count_scene(const Scene& scene, const CountingRule& rule);

}  // namespace slammot::metrics
