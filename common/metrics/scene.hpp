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

/// An object as it truly was at the time of one scan.
struct TrueObject {
  std::size_t object = 0;               ///< Index in the drive.
  std::string object_class;
  geometry::Pose2 world_from_object;    ///< Centre of its box, x along its length.
  double speed_mps = 0.0;               ///< Along its heading.
  double length_m = 0.0;
  double width_m = 0.0;
  int points = 0;                       ///< Echoes of this scan from it; 0 while it is hidden.
};

/// Where a track was said to be so much later, in the frame of whoever holds it.
struct PredictedPlace {
  double after_s = 0.0;
  geometry::Vector2 position_m = geometry::Vector2::Zero();
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();
};

/// A track as it was reported for one scan, brought into the world's frame.
struct ReportedTrack {
  std::size_t track = 0;                ///< Index in the drive.
  std::string object_class;
  geometry::Pose2 world_from_object;
  geometry::Vector2 velocity_in_world_mps = geometry::Vector2::Zero();
  double length_m = 0.0;
  double width_m = 0.0;
  bool is_moving = true;                ///< As reported.
  std::optional<geometry::Matrix2> position_covariance_m2;  ///< In world.
  std::vector<PredictedPlace> predicted = {};  ///< In world.
};

struct Scene {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 world_from_base;
  std::vector<TrueObject> objects;
  std::vector<ReportedTrack> tracks;
};

/// Which objects count, and what is near enough; docs/evaluation.md has the reasons.
struct CountingRule {
  double range_m = 50.0;             ///< Objects farther from the vehicle do not count,
  double first_bearing_rad = -std::numbers::pi;  ///< nor those outside of these directions from the vehicle, against its axis,
  double last_bearing_rad = std::numbers::pi;    ///< which may be all that the truth knows of,
  double least_speed_mps = 0.5;      ///< nor do slower ones,
  int least_points = 3;              ///< nor those with fewer echoes.
  double dont_care_margin_m = 1.0;   ///< A track this near to the box of such an object counts neither way.
  double gate_m = 2.0;               ///< From a track's position to the true box: farther is no match.
  double similarity_reach_m = 4.0;   ///< Similarity is max(0, 1 - distance / this).
};

/// The part of a scene that counts.
struct CountedScene {
  MotFrame frame;
  std::vector<std::size_t> objects;  ///< Index in Scene::objects of each row,
  std::vector<std::size_t> tracks;   ///< and in Scene::tracks of each column.
  Eigen::MatrixXd distance_m;        ///< From the track's position to the object's box.
};

/// From the point to the object's box; 0 inside. [m]
double distance_to_box_m(const geometry::Vector2& point_in_world_m, const TrueObject& object);

/// Whether the tracker is asked for the object in this scene.
bool does_count(const TrueObject& object, const Scene& scene, const CountingRule& rule);

/// Adds hidden objects: between two rows of an object at most longest_gap_ns apart it is where the line between them
/// says, with no points. A track that is carried through an occlusion is then near something. Scenes ascend in time.
std::vector<Scene> fill_gaps(std::vector<Scene> scenes, std::int64_t longest_gap_ns);

/// All objects, those that do not count too, are first paired with tracks by similarity. Then a track is left out when
/// its partner does not count; or when it has none and is within the margin of an object that does not count, or out
/// of range or of the bearings that count.
CountedScene count_scene(const Scene& scene, const CountingRule& rule);

}  // namespace slammot::metrics
