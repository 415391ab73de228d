#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/geometry/pose2.hpp"

namespace slammot::city_model {

/// Box of a tracked object at one scan, in the map as it was when the scan was published.
struct TrackedBox {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 map_from_object;  ///< Centre, x along its length.
  geometry::Vector2 velocity_in_map_mps = geometry::Vector2::Zero();
  double length_m = 0.0;
  double width_m = 0.0;
};

/// Places of the tracked objects at any time of a drive, known afterwards: between two scans the
/// box is interpolated; before its first and after its last one it moves on with constant velocity,
/// since an object leaves the view of the tracking scanner before it leaves that of another one.
class MoverBoxes {
 public:
  struct Reach {
    double margin_m = 0.5;  ///< Around each box.
    double before_s = 2.0;  ///< Before a track was confirmed.
    double after_s = 3.0;   ///< After its last scan.
  };

  MoverBoxes() : MoverBoxes(Reach{}) {}
  explicit MoverBoxes(const Reach& reach) : reach_(reach) {}

  /// Boxes of one track with ascending stamps.
  void add(std::uint32_t track_id, const TrackedBox& box) { tracks_[track_id].push_back(box); }

  /// Boxes at that time, with the margin.
  std::vector<TrackedBox> at(std::int64_t stamp_ns) const;

 private:
  Reach reach_;
  std::map<std::uint32_t, std::vector<TrackedBox>> tracks_;
};

bool contains(const TrackedBox& box, const geometry::Vector2& point_in_map_m);

}  // namespace slammot::city_model
