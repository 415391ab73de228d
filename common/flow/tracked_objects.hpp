#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/flow/ids.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::flow {

enum class Motion : std::uint8_t { kMoving, kStopped };
enum class ObjectClass : std::uint8_t { kUnknown, kPedestrian, kBicycle, kCar, kTruckOrBus };

/// Probabilities of pedestrian, bicycle, car, truck or bus; of sum 1, or all zero if not computed.
using ClassProbabilities = std::array<double, 4>;

/// Class of an entry of ClassProbabilities.
constexpr ObjectClass class_of(std::size_t entry) { return static_cast<ObjectClass>(entry + 1); }

struct PredictedPosition {
  double after_s = 0.0;
  Eigen::Vector2d position_in_odom_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
};

/// State of a tracked object at the stamp of the message.
struct TrackedObject {
  TrackId track_id;
  bool confirmed = false;
  double existence = 0.0;                                        ///< Probability, [0, 1].
  Eigen::Vector2d position_in_odom_m = Eigen::Vector2d::Zero();  ///< Estimated centre of the
                                                                 ///< object's box.
  Eigen::Vector2d velocity_in_odom_mps = Eigen::Vector2d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();  ///< (x, y [m], vx, vy [m/s]) in odom,
                                                         ///< including the pose's uncertainty.
  Eigen::Vector2d acceleration_in_odom_mps2 = Eigen::Vector2d::Zero();
  double heading_in_odom_rad = 0.0;  ///< Of the box's length, in the direction of motion if known.
  double length_m = 0.0;
  double width_m = 0.0;
  Motion motion = Motion::kMoving;
  ObjectClass object_class = ObjectClass::kUnknown;
  std::array<double, 3> mode_probability = {0.0, 0.0, 0.0};  ///< Constant velocity, constant
                                                             ///< acceleration, coordinated turn.
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;                   ///< Last scan in which a segment was associated.
  std::vector<Eigen::Vector2f> contour_in_odom_m;  ///< At most 64 points seen on the object.
  std::vector<PredictedPosition> predicted_path;   ///< At most 16, ascending in time.
  ClassProbabilities class_probability = {};       ///< From size and motion; object_class is the
                                                   ///< likeliest.
  bool occluded = false;  ///< Confirmed, but without an echo in this scan, or only with echoes that
                          ///< may be another object's: the state is predicted.

  /// All members, for memory::StateVisitor. Does not compile where one is missing.
  static void visit_state(auto& self, auto& visit) {
    auto& [id, is_confirmed, probability, position, velocity, covariance_of_both, acceleration,
           heading, length, width, motion_state, likeliest, modes, first_seen, last_seen, contour,
           path, classes, is_occluded] = self;
    visit(id, is_confirmed, probability, position, velocity, covariance_of_both, acceleration,
          heading, length, width, motion_state, likeliest, modes, first_seen, last_seen, contour,
          path, classes, is_occluded);
  }
};

struct TrackedObjects {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;     ///< Of the scan.
  geometry::Pose2 map_from_odom;  ///< As of that scan: map_from_odom * position_in_odom is the
                                  ///< position in map.
  geometry::Pose2 odom_from_base;
  std::vector<TrackedObject> objects;  ///< Including tentative ones.
  MapId map_id{};
  OdomId odom_id{};
};

}  // namespace slammot::flow
