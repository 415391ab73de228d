#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/street_network.hpp"

namespace slammot::streets {

/// A square of the frame `streets`.
struct Area {
  geometry::Vector2 centre_m = geometry::Vector2::Zero();
  double half_side_m = 0.0;
};

/// The nearest street that runs in a given direction, for every place of an area: a raster with one
/// layer for each range of directions, so that a crossing street does not count as the one driven
/// on.
class StreetField {
 public:
  /// Cells are 2 m wide, wider where the area is large.
  StreetField(const StreetNetwork& network, const Area& area);

  struct Nearest {
    const LinkSegment* part = nullptr;
    geometry::Vector2 point_m;  ///< On the street.
    double distance_m = 0.0;
    double direction_rad = 0.0;  ///< Of the street, in the sense of the heading.

    /// Share of the link's length before the point.
    double share_of_link() const {
      const double share = (point_m - part->segment.from_m).norm() / part->segment.length_m();
      return part->share_from + share * (part->share_to - part->share_from);
    }
  };

  /// Nearest street whose direction differs from the heading, in either sense, by at most about 30
  /// degrees; none within kReach_m.
  std::optional<Nearest> nearest(const geometry::Pose2& streets_from_base) const;

  /// Parts of streets within the area.
  const std::vector<LinkSegment>& segments() const { return segments_; }

  static constexpr double kReach_m = 24.0;

 private:
  static constexpr int kLayers = 6;  ///< Of 30 degrees each.

  void draw(std::int32_t segment);
  std::size_t index(int layer, std::int64_t column, std::int64_t row) const;

  std::vector<LinkSegment> segments_;
  geometry::Vector2 min_m_;
  double cell_m_ = 2.0;
  std::int64_t side_ = 0;              ///< Cells.
  std::vector<std::int32_t> nearest_;  ///< Index of a segment, or -1; by layer, row, column.
};

}  // namespace slammot::streets
