#include "common/metrics/outline_seen.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::metrics {
namespace {

constexpr double kPieceM = 0.5;

double perimeter_m(const TrueObject& object) { return 2.0 * (object.length_m + object.width_m); }

/// Way along the outline from the middle of the front, counter-clockwise, to the point of a side
/// that is nearest [m].
double place_on_outline_m(const TrueObject& object, const geometry::Vector2& point_in_world_m) {
  const geometry::Vector2 at_m = geometry::inverse(object.world_from_object) * point_in_world_m;
  const double x_m = 0.5 * object.length_m;
  const double y_m = 0.5 * object.width_m;
  const double along_m = std::clamp(at_m.x(), -x_m, x_m);
  const double across_m = std::clamp(at_m.y(), -y_m, y_m);
  const bool is_on_end = x_m - std::abs(at_m.x()) < y_m - std::abs(at_m.y());
  if (is_on_end && at_m.x() > 0.0)
    return across_m >= 0.0 ? across_m : perimeter_m(object) + across_m;
  if (is_on_end) return y_m + 2.0 * x_m + (y_m - across_m);
  return at_m.y() > 0.0 ? y_m + (x_m - along_m) : 3.0 * y_m + 2.0 * x_m + (along_m + x_m);
}

}  // namespace

void OutlinesSeen::add(const TrueObject& object, const geometry::Vector2& point_in_world_m) {
  if (!(object.length_m > 0.0 && object.width_m > 0.0)) return;
  std::vector<bool>& pieces = pieces_[object.object];
  if (pieces.empty())
    pieces.resize(static_cast<std::size_t>(std::ceil(perimeter_m(object) / kPieceM)));
  const double share = place_on_outline_m(object, point_in_world_m) / perimeter_m(object);
  const auto piece = static_cast<std::size_t>(share * static_cast<double>(pieces.size()));
  pieces[std::min(piece, pieces.size() - 1)] = true;
}

double OutlinesSeen::share_of(const TrueObject& object) const {
  const auto found = pieces_.find(object.object);
  if (found == pieces_.end()) return 0.0;
  return static_cast<double>(std::ranges::count(found->second, true)) /
         static_cast<double>(found->second.size());
}

}  // namespace slammot::metrics
