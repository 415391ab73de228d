#include "common/wire/traffic_ways.hpp"

#include <algorithm>
#include <utility>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

static_assert(static_cast<int>(traffic::Mover::kVehicle) == slammot_WAY_KIND_LANE);
static_assert(static_cast<int>(traffic::Mover::kBicycle) == slammot_WAY_KIND_CYCLE_LANE);
static_assert(static_cast<int>(traffic::Mover::kPedestrian) == slammot_WAY_KIND_WALKWAY);

std::size_t points_on_the_wire(const traffic::Way& way) {
  return std::min(way.points_in_map_m.size(), kMostWayPointsOfPart);
}

/// Index of the first way of each part, and of the end.
std::vector<std::size_t> parts_of(const std::vector<traffic::Way>& ways) {
  std::vector<std::size_t> begins = {0};
  std::size_t points = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const std::size_t own = points_on_the_wire(ways[i]);
    if (points + own > kMostWayPointsOfPart || i - begins.back() >= kMostWaysOfPart) {
      if (begins.size() == kMostPartsOfWays) {
        begins.push_back(i);
        return begins;
      }
      begins.push_back(i);
      points = 0;
    }
    points += own;
  }
  begins.push_back(ways.size());
  return begins;
}

slammot_TrafficWay encoded_way(const traffic::Way& way) {
  slammot_TrafficWay sample{};
  sample.kind = static_cast<slammot_WayKind>(way.mover);
  sample.line_number = static_cast<std::uint32_t>(way.line);
  sample.point_count = static_cast<std::uint32_t>(points_on_the_wire(way));
  sample.speed_mps = static_cast<float>(way.speed_mps);
  sample.speed_spread_mps = static_cast<float>(way.speed_spread_mps);
  sample.width_m = static_cast<float>(way.width_m);
  sample.tracks = static_cast<float>(way.tracks);
  sample.confidence = static_cast<float>(way.confidence);
  return sample;
}

traffic::Way decoded_way(const slammot_TrafficWay& sample) {
  traffic::Way way;
  way.mover = static_cast<traffic::Mover>(sample.kind);
  way.line = static_cast<int>(sample.line_number);
  way.speed_mps = static_cast<double>(sample.speed_mps);
  way.speed_spread_mps = static_cast<double>(sample.speed_spread_mps);
  way.width_m = static_cast<double>(sample.width_m);
  way.tracks = static_cast<double>(sample.tracks);
  way.confidence = static_cast<double>(sample.confidence);
  return way;
}

std::string_view fault_of_way(const slammot_TrafficWay& way) {
  constexpr std::uint32_t kHighestLine = 0x7FFF'FFFF;
  if (!is_enumerator(way.kind, slammot_WAY_KIND_WALKWAY)) return "a way's kind is unknown";
  if (way.line_number > kHighestLine) return "a line has no sound number";
  if (way.point_count < 2) return "a way has less than two points";
  for (const float amount : {way.speed_mps, way.speed_spread_mps, way.width_m, way.tracks}) {
    if (!is_amount(static_cast<double>(amount)))
      return "a way's speed, width or number of tracks is negative or not finite";
  }
  if (!is_probability(static_cast<double>(way.confidence)))
    return "a way's confidence is not within 0 and 1";
  return "";
}

std::string_view fault_of_ways(const slammot_TrafficWays& part) {
  if (part.part_count == 0 || part.part_count > kMostPartsOfWays)
    return "part_count is not within 1 and 64";
  if (part.part_index >= part.part_count) return "part_index is not below part_count";
  std::uint64_t points = 0;
  for (const slammot_TrafficWay& way : elements(part.ways)) {
    if (const std::string_view fault = fault_of_way(way); !fault.empty()) return fault;
    points += way.point_count;
  }
  if (points != part.points._length) return "points does not have what the ways count";
  for (const slammot_Point2f& point : elements(part.points)) {
    if (!is_sound(static_cast<double>(point.x_m)) || !is_sound(static_cast<double>(point.y_m)))
      return "a way's point is not finite";
  }
  return "";
}

std::vector<traffic::Way> decoded_ways(const slammot_TrafficWays& part) {
  std::vector<traffic::Way> ways;
  ways.reserve(part.ways._length);
  auto points = elements(part.points);
  for (const slammot_TrafficWay& sample : elements(part.ways)) {
    traffic::Way& way = ways.emplace_back(decoded_way(sample));
    for (const slammot_Point2f& point : points.first(sample.point_count))
      way.points_in_map_m.push_back(decode(point).cast<double>());
    points = points.subspan(sample.point_count);
  }
  return ways;
}

}  // namespace

void TrafficWaysEncoder::fill(const std::vector<traffic::Way>& ways, std::size_t begin,
                              std::size_t end) {
  ways_.clear();
  points_.clear();
  for (std::size_t i = begin; i < end; ++i) {
    ways_.push_back(encoded_way(ways[i]));
    for (std::size_t j = 0; j < points_on_the_wire(ways[i]); ++j)
      points_.push_back(wire::encode(Eigen::Vector2f(ways[i].points_in_map_m[j].cast<float>())));
  }
  show(sample_.ways, ways_);
  show(sample_.points, points_);
}

std::size_t TrafficWaysEncoder::encode(
    std::string_view vehicle_id, const traffic::TrafficWays& ways,
    const std::function<void(const slammot_TrafficWays&)>& write) {
  const std::vector<std::size_t> begins = parts_of(ways.ways);
  set_text(sample_.vehicle_id, vehicle_id);
  sample_.sequence_number = ways.sequence;
  sample_.part_count = static_cast<std::uint32_t>(begins.size() - 1);
  sample_.map_id = ways.map_id.value;
  sample_.stamp_ns = ways.stamp_ns;
  for (std::size_t part = 0; part + 1 < begins.size(); ++part) {
    sample_.part_index = static_cast<std::uint32_t>(part);
    fill(ways.ways, begins[part], begins[part + 1]);
    write(sample_);
  }
  return ways.ways.size() - begins.back();
}

TrafficWaysAssembler::Added TrafficWaysAssembler::add(const slammot_TrafficWays& part) {
  if (const std::string_view fault = fault_of_ways(part); !fault.empty())
    return {std::nullopt, fault};
  auto complete = parts_.add(part.sequence_number, part.part_index, part.part_count,
                             {part.stamp_ns, {part.map_id}}, decoded_ways(part));
  if (!complete) return {};
  const auto& [stamp_ns, map_id] = complete->shared;
  return {traffic::TrafficWays{part.sequence_number, stamp_ns, map_id, std::move(complete->items)},
          ""};
}

}  // namespace slammot::wire
