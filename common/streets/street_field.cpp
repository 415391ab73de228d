#include "common/streets/street_field.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slammot::streets {
namespace {

using geometry::Vector2;

constexpr double kMostCells = 4e6;  // of one layer
constexpr double kPi = std::numbers::pi;

bool overlaps(const Segment& segment, const Area& area) {
  const Vector2 low_m = segment.from_m.cwiseMin(segment.to_m);
  const Vector2 high_m = segment.from_m.cwiseMax(segment.to_m);
  const double reach_m = area.half_side_m + StreetField::kReach_m;
  return ((low_m - area.centre_m).array() <= reach_m).all() &&
         ((high_m - area.centre_m).array() >= -reach_m).all();
}

/// Direction without a sense, [0, pi).
double undirected(double direction_rad) {
  const double half_turns = direction_rad / kPi;
  return kPi * (half_turns - std::floor(half_turns));
}

}  // namespace

StreetField::StreetField(const StreetNetwork& network, const Area& area)
    : min_m_(area.centre_m - Vector2::Constant(area.half_side_m)) {
  for (const LinkSegment& part : network.segments()) {
    if (overlaps(part.segment, area)) segments_.push_back(part);
  }
  cell_m_ = std::max(cell_m_, 2.0 * area.half_side_m / std::sqrt(kMostCells));
  side_ = static_cast<std::int64_t>(std::ceil(2.0 * area.half_side_m / cell_m_));
  nearest_.assign(static_cast<std::size_t>(kLayers * side_ * side_), -1);
  for (std::size_t i = 0; i < segments_.size(); ++i) draw(static_cast<std::int32_t>(i));
}

std::size_t StreetField::index(int layer, std::int64_t column, std::int64_t row) const {
  return static_cast<std::size_t>((layer * side_ + row) * side_ + column);
}

/// Enters a segment into the cells around it, in the layer of its direction and both beside it.
void StreetField::draw(std::int32_t number) {
  const Segment& segment = segments_[static_cast<std::size_t>(number)].segment;
  const int own = static_cast<int>(undirected(segment.direction_rad()) / kPi * kLayers) % kLayers;
  const auto cell_of = [&](double offset_m) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(offset_m / cell_m_)), 0,
                                    side_ - 1);
  };
  const Vector2 low_m =
      segment.from_m.cwiseMin(segment.to_m) - Vector2::Constant(kReach_m) - min_m_;
  const Vector2 high_m =
      segment.from_m.cwiseMax(segment.to_m) + Vector2::Constant(kReach_m) - min_m_;
  for (std::int64_t row = cell_of(low_m.y()); row <= cell_of(high_m.y()); ++row) {
    for (std::int64_t column = cell_of(low_m.x()); column <= cell_of(high_m.x()); ++column) {
      const Vector2 centre_m = min_m_ + cell_m_ * Vector2(static_cast<double>(column) + 0.5,
                                                          static_cast<double>(row) + 0.5);
      const double distance_m = (segment.nearest_to(centre_m) - centre_m).norm();
      if (distance_m > kReach_m) continue;
      for (const int layer : {own, (own + 1) % kLayers, (own + kLayers - 1) % kLayers}) {
        std::int32_t& known = nearest_[index(layer, column, row)];
        const bool is_nearer =
            known < 0 ||
            distance_m <
                (segments_[static_cast<std::size_t>(known)].segment.nearest_to(centre_m) - centre_m)
                    .norm();
        if (is_nearer) known = number;
      }
    }
  }
}

std::optional<StreetField::Nearest> StreetField::nearest(
    const geometry::Pose2& streets_from_base) const {
  const Vector2 place_m = streets_from_base.translation_m();
  const Vector2 cell = (place_m - min_m_) / cell_m_;
  if (!(cell.array() >= 0.0).all() || !(cell.array() < static_cast<double>(side_)).all())
    return std::nullopt;
  const int layer =
      static_cast<int>(undirected(streets_from_base.heading_rad) / kPi * kLayers) % kLayers;
  const std::int32_t number = nearest_[index(layer, static_cast<std::int64_t>(cell.x()),
                                             static_cast<std::int64_t>(cell.y()))];
  if (number < 0) return std::nullopt;
  const LinkSegment& part = segments_[static_cast<std::size_t>(number)];
  const Segment& segment = part.segment;
  const Vector2 point_m = segment.nearest_to(place_m);
  const double direction_rad = part.direction_rad;
  const bool is_against =
      std::abs(geometry::wrap_angle(direction_rad - streets_from_base.heading_rad)) > 0.5 * kPi;
  return Nearest{&part, point_m, (point_m - place_m).norm(),
                 geometry::wrap_angle(is_against ? direction_rad + kPi : direction_rad)};
}

}  // namespace slammot::streets
