#include "common/traffic/way_accuracy.hpp"

#include <cmath>

#include "common/traffic/point_index.hpp"

namespace slammot::traffic {
namespace {

using geometry::Vector2;

constexpr double kSampleM = 0.2;

/// Calls visit(position_m, direction, length_m) for the pieces of a segment.
template <typename Visit>
void sample(const Vector2& from_m, const Vector2& to_m, const Visit& visit) {
  const double length_m = (to_m - from_m).norm();
  if (length_m <= 0.0) return;
  const Vector2 direction = (to_m - from_m) / length_m;
  const int pieces = static_cast<int>(std::ceil(length_m / kSampleM));
  for (int i = 0; i < pieces; ++i)
    visit(Vector2(from_m + (i + 0.5) / pieces * (to_m - from_m)), direction, length_m / pieces);
}

template <typename Visit>
void sample(const Way& way, const Visit& visit) {
  for (std::size_t i = 1; i < way.points_in_map_m.size(); ++i)
    sample(way.points_in_map_m[i - 1], way.points_in_map_m[i], visit);
}

class OnLines {
 public:
  OnLines(Mover mover, const WayRule& rule) : is_directed_(is_directed(mover)), rule_(rule) {}

  void add(const Vector2& position_m, const Vector2& direction) {
    points_.add({position_m, direction});
  }

  bool operator()(const Vector2& position_m, const Vector2& direction) const {
    const double least_cosine = std::cos(rule_.angle_rad);
    return points_.any_near(position_m, rule_.distance_m, [&](const LinePoint& at) {
      const double cosine = at.direction.dot(direction);
      return (is_directed_ ? cosine : std::abs(cosine)) >= least_cosine &&
             (at.position_m - position_m).norm() <= rule_.distance_m;
    });
  }

 private:
  bool is_directed_;
  WayRule rule_;
  PointIndex points_;
};

WayAccuracy judge(Mover mover, const std::vector<Way>& ways, const std::vector<TrueStep>& steps,
                  const WayRule& rule) {
  const auto counts = [&](const Way& way) {
    return way.mover == mover && way.confidence >= rule.least_confidence;
  };
  OnLines is_on_way(mover, rule);
  OnLines is_on_truth(mover, rule);
  for (const Way& way : ways) {
    if (!counts(way)) continue;
    sample(way, [&](const Vector2& at_m, const Vector2& direction, double) {
      is_on_way.add(at_m, direction);
    });
  }
  WayAccuracy accuracy;
  for (const TrueStep& step : steps) {
    if (step.mover != mover) continue;
    sample(step.from_m, step.to_m, [&](const Vector2& at_m, const Vector2& along, double piece_m) {
      is_on_truth.add(at_m, along);
      if (!step.is_in_view) return;
      accuracy.travelled_m += piece_m;
      if (is_on_way(at_m, along)) accuracy.found_m += piece_m;
    });
  }
  for (const Way& way : ways) {
    if (!counts(way)) continue;
    sample(way, [&](const Vector2& at_m, const Vector2& along, double piece_m) {
      accuracy.length_m += piece_m;
      if (is_on_truth(at_m, along)) accuracy.true_m += piece_m;
    });
  }
  return accuracy;
}

}  // namespace

std::array<WayAccuracy, kMovers> judge(const std::vector<Way>& ways,
                                       const std::vector<TrueStep>& steps, const WayRule& rule) {
  std::array<WayAccuracy, kMovers> accuracy;
  for (int i = 0; i < kMovers; ++i)
    accuracy[static_cast<std::size_t>(i)] = judge(static_cast<Mover>(i), ways, steps, rule);
  return accuracy;
}

}  // namespace slammot::traffic
