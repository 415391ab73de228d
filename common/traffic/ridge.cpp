#include "common/traffic/ridge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/traffic/point_index.hpp"

namespace slammot::traffic {
namespace {

using geometry::Vector2;

constexpr double kLeastTracks = 0.5;
constexpr double kSettledM = 0.02;
constexpr int kFirstIterations = 8;  // at a seed
constexpr int kIterations = 2;       // after each step
constexpr double kLeastStepCosine = 0.85;
constexpr int kMostSteps = 20'000;

double epanechnikov(double offset, double reach) {
  const double ratio = offset / reach;
  return 1.0 - ratio * ratio;
}

Vector2 left_of(const Vector2& direction) { return {-direction.y(), direction.x()}; }

/// Streams about a place, as seen in a direction.
class Neighbours {
 public:
  Neighbours(const TrafficMap& map, Mover mover, const RidgeScale& scale)
      : map_(map), mover_(mover), scale_(scale) {}

  /// Calls visit(stream, along_m, across_m, direction, cosine) for each stream within the kernel
  /// that agrees in direction. Those of an undirected way are turned to agree.
  template <typename Visit>
  void visit(const RidgePoint& at, const Visit& visit) {
    found_.clear();
    map_.append_near(mover_, at.position_m, std::max(scale_.along_m, scale_.across_m), found_);
    const Vector2 left = left_of(at.direction);
    for (const PlacedStream& placed : found_) {
      const Vector2 offset_m = placed.position_m - at.position_m;
      const double along_m = offset_m.dot(at.direction);
      const double across_m = offset_m.dot(left);
      if (std::abs(along_m) >= scale_.along_m || std::abs(across_m) >= scale_.across_m) continue;
      Vector2 direction = placed.stream->direction();
      double cosine = direction.dot(at.direction);
      if (cosine < 0.0 && !is_directed(mover_)) direction = -direction, cosine = -cosine;
      if (cosine >= scale_.least_cosine)
        visit(*placed.stream, along_m, across_m, direction, cosine);
    }
  }

  const RidgeScale& scale() const { return scale_; }

 private:
  const TrafficMap& map_;
  Mover mover_;
  RidgeScale scale_;
  std::vector<PlacedStream> found_;
};

/// One mean shift across the direction, and the mean direction; false if nothing is near.
bool shift(Neighbours& neighbours, RidgePoint& point, double& shift_m) {
  const RidgeScale& scale = neighbours.scale();
  double weight = 0.0;
  double across_sum_m = 0.0;
  Vector2 direction_sum = Vector2::Zero();
  neighbours.visit(point, [&](const Stream& stream, double along_m, double across_m,
                              const Vector2& direction, double cosine) {
    const double kernel = static_cast<double>(stream.weight) * cosine * cosine *
                          epanechnikov(along_m, scale.along_m) *
                          epanechnikov(across_m, scale.across_m);
    weight += kernel;
    across_sum_m += kernel * across_m;
    direction_sum += kernel * direction;
  });
  if (weight <= 0.0) return false;
  shift_m = across_sum_m / weight;
  point.position_m += shift_m * left_of(point.direction);
  point.direction = direction_sum.normalized();
  return true;
}

/// Fills in what passes the section at the point.
void measure(Neighbours& neighbours, RidgePoint& point) {
  double length_m = 0.0;
  double weight = 0.0;
  double resultant = 0.0;
  double speed_sum = 0.0;
  double squared_speed_sum = 0.0;
  double width_sum_m = 0.0;
  double across_sum_m = 0.0;
  double squared_across_sum = 0.0;
  neighbours.visit(
      point, [&](const Stream& stream, double, double across_m, const Vector2&, double cosine) {
        const auto w = static_cast<double>(stream.weight);
        length_m += static_cast<double>(stream.length_m) * cosine;
        weight += w;
        resultant += w * stream.agreement() * cosine;
        speed_sum += static_cast<double>(stream.speed_sum_mps);
        squared_speed_sum += static_cast<double>(stream.squared_speed_sum);
        width_sum_m += static_cast<double>(stream.width_sum_m);
        across_sum_m += w * across_m;
        squared_across_sum += w * across_m * across_m;
      });
  if (weight <= 0.0) return;
  const auto spread = [&](double sum, double squared_sum) {
    return std::sqrt(std::max(0.0, squared_sum / weight - std::pow(sum / weight, 2)));
  };
  point.tracks = length_m / (2.0 * neighbours.scale().along_m);
  point.agreement = resultant / weight;
  point.speed_mps = speed_sum / weight;
  point.speed_spread_mps = spread(speed_sum, squared_speed_sum);
  point.mover_width_m = width_sum_m / weight;
  point.spread_m = spread(across_sum_m, squared_across_sum);
}

std::optional<RidgePoint> settle(Neighbours& neighbours, RidgePoint point, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    double shift_m = 0.0;
    if (!shift(neighbours, point, shift_m)) return std::nullopt;
    if (std::abs(shift_m) < kSettledM) break;
  }
  measure(neighbours, point);
  if (point.tracks < kLeastTracks) return std::nullopt;
  return point;
}

/// The lines found so far. Follows one line at a time.
class RidgeFollower {
 public:
  RidgeFollower(const TrafficMap& map, Mover mover)
      : neighbours_(map, mover, ridge_scale(mover)), is_directed_(is_directed(mover)) {}

  /// The line through a seed; empty if another one covers it.
  std::vector<RidgePoint> line_through(const RidgePoint& seed) {
    const double beside_m = kBeside * neighbours_.scale().across_m;
    ++line_;
    if (meets_line(seed, 0, beside_m)) return {};
    const auto start = settle(neighbours_, seed, kFirstIterations);
    if (!start || meets_line(*start, 0, beside_m)) return {};
    add(*start, 0);
    std::vector<RidgePoint> line = follow(*start, -1);
    std::ranges::reverse(line);
    line.push_back(*start);
    const std::vector<RidgePoint> ahead = follow(*start, 1);
    line.insert(line.end(), ahead.begin(), ahead.end());
    return line;
  }

 private:
  static constexpr double kBeside = 0.75;    ///< Of the kernel: no line begins so near to another.
  static constexpr double kJoining = 0.2;    ///< Of the kernel: a line ends so near to another.
  static constexpr double kParallel = 0.87;  ///< Cosine of 30 degrees.
  static constexpr double kRecentM = 6.0;    ///< So far behind its end, a line may join itself.

  void add(const RidgePoint& point, int station) {
    points_.add({point.position_m, point.direction, line_, station});
  }

  /// True if a line runs there in that direction: another one, or this one at a distant station.
  bool meets_line(const RidgePoint& point, int station, double across_m) const {
    const double step_m = neighbours_.scale().step_m;
    const auto recent = static_cast<int>(kRecentM / step_m);
    const Vector2 left = left_of(point.direction);
    return points_.any_near(point.position_m, std::max(step_m, across_m), [&](const LinePoint& at) {
      if (at.line == line_ && std::abs(at.station - station) < recent) return false;
      const double cosine = at.direction.dot(point.direction);
      const Vector2 offset_m = at.position_m - point.position_m;
      return (is_directed_ ? cosine : std::abs(cosine)) >= kParallel &&
             std::abs(offset_m.dot(point.direction)) < step_m &&
             std::abs(offset_m.dot(left)) < across_m;
    });
  }

  /// Points from the start on, without it; `sign` -1: against the direction of travel.
  std::vector<RidgePoint> follow(const RidgePoint& start, int sign) {
    const double joining_m = kJoining * neighbours_.scale().across_m;
    std::vector<RidgePoint> line;
    RidgePoint last = start;
    for (int station = sign; std::abs(station) < kMostSteps; station += sign) {
      RidgePoint guess = last;
      guess.position_m += sign * neighbours_.scale().step_m * last.direction;
      const auto next = settle(neighbours_, guess, kIterations);
      if (!next) break;
      const Vector2 step = (next->position_m - last.position_m).normalized();
      if (sign * step.dot(last.direction) < kLeastStepCosine) break;
      line.push_back(*next);
      if (meets_line(*next, station, joining_m)) break;
      add(*next, station);
      last = *next;
    }
    return line;
  }

  Neighbours neighbours_;
  bool is_directed_;
  PointIndex points_;
  int line_ = 0;
};

}  // namespace

RidgeScale ridge_scale(Mover mover) {
  switch (mover) {
    case Mover::kVehicle: return {};
    case Mover::kBicycle: return {2.0, 1.0, 0.71, 1.0};
    case Mover::kPedestrian: return {1.5, 1.0, 0.71, 0.5};
  }
  return {};
}

std::optional<RidgePoint> ridge_point(const TrafficMap& map, Mover mover, const RidgePoint& near,
                                      int iterations) {
  Neighbours neighbours(map, mover, ridge_scale(mover));
  return settle(neighbours, near, iterations);
}

std::vector<std::vector<RidgePoint>> follow_ridges(const TrafficMap& map, Mover mover) {
  std::vector<PlacedStream> seeds = map.streams(mover);
  std::ranges::stable_sort(seeds, std::ranges::greater{},
                           [](const PlacedStream& seed) { return seed.stream->weight; });
  RidgeFollower follower(map, mover);
  std::vector<std::vector<RidgePoint>> lines;
  for (const PlacedStream& seed : seeds) {
    RidgePoint point;
    point.position_m = seed.position_m;
    point.direction = seed.stream->direction();
    std::vector<RidgePoint> line = follower.line_through(point);
    if (line.size() > 1) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace slammot::traffic
