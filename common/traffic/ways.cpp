#include "common/traffic/ways.hpp"

#include <span>

#include "common/traffic/ridge.hpp"

namespace slammot::traffic {
namespace {

constexpr double kLeastLengthM = 4.0;  // of a line
constexpr double kPieceOfLineM = 25.0;

double length_m(std::span<const RidgePoint> line) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < line.size(); ++i)
    sum_m += (line[i].position_m - line[i - 1].position_m).norm();
  return sum_m;
}

Way way_of(Mover mover, int line, std::span<const RidgePoint> piece) {
  Way way;
  way.mover = mover;
  way.line = line;
  double resultant = 0.0;
  const double share = 1.0 / static_cast<double>(piece.size());
  for (const RidgePoint& point : piece) {
    way.points_in_map_m.push_back(point.position_m);
    way.speed_mps += share * point.speed_mps;
    way.speed_spread_mps += share * point.speed_spread_mps;
    way.width_m += share * (point.mover_width_m + 4.0 * point.spread_m);
    way.tracks += share * point.tracks;
    resultant += share * point.tracks * point.agreement;
  }
  way.confidence = resultant / (way.tracks + 1.0);
  return way;
}

/// Cuts the line into pieces of about equal length; neighbours share a point.
void append_pieces(Mover mover, int line, std::span<const RidgePoint> points,
                   std::vector<Way>& ways) {
  const auto pieces = static_cast<std::size_t>(length_m(points) / kPieceOfLineM) + 1;
  const std::size_t steps = points.size() - 1;
  for (std::size_t i = 0; i < pieces; ++i) {
    const std::size_t from = i * steps / pieces;
    const std::size_t to = (i + 1) * steps / pieces;
    if (to > from) ways.push_back(way_of(mover, line, points.subspan(from, to - from + 1)));
  }
}

}  // namespace

std::vector<Way> find_ways(const TrafficMap& map) {
  std::vector<Way> ways;
  int line = 0;
  for (const Mover mover : {Mover::kVehicle, Mover::kBicycle, Mover::kPedestrian}) {
    for (const std::vector<RidgePoint>& points : follow_ridges(map, mover)) {
      if (length_m(points) >= kLeastLengthM) append_pieces(mover, line++, points, ways);
    }
  }
  return ways;
}

}  // namespace slammot::traffic
