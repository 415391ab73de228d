#include "services/detection/label_runs.hpp"

#include <algorithm>
#include <cmath>

#include "services/detection/point_labels.hpp"

namespace slammot::detection {
namespace {

using flow::PointLabel;
using flow::SegmentedScan;

/// Fewest neighbouring beams of one label that are a segment of their own.
constexpr int kLeastMovingRun = 2;
constexpr int kLeastStationaryRun = 3;

void merge_with_equal_neighbours(std::vector<Run>& runs) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (runs[i].is_moving == runs[kept].is_moving) runs[kept].count += runs[i].count;
    else runs[++kept] = runs[i];
  }
  if (!runs.empty()) runs.resize(kept + 1);
}

bool lies_on_line(const Eigen::Vector2f& from, const Eigen::Vector2f& to,
                  const Eigen::Vector2f& point, double within_m) {
  const Eigen::Vector2f way = to - from;
  const Eigen::Vector2f off = point - from;
  return std::abs(way.x() * off.y() - way.y() * off.x()) <=
         static_cast<float>(within_m) * way.norm();
}

/// True if the moving run continues the line of the stationary runs beside it: a wall whose cells
/// the map does not know completely.
bool continues_wall(std::size_t index, const std::vector<Run>& runs,
                    std::span<const std::uint16_t> beams, const SegmentedScan& scan) {
  constexpr std::size_t kBack = 4;
  const auto point = [&](std::size_t i) { return scan.points_in_base_m[beams[i]]; };
  const Run& run = runs[index];
  const std::size_t end = run.first + run.count;
  const bool has_before = index > 0;
  const bool has_after = index + 1 < runs.size();
  if ((!has_before && !has_after) ||
      (has_before != has_after && runs[has_before ? index - 1 : index + 1].count < 3))
    return false;
  const std::size_t from =
      has_before ? run.first - (has_after ? 1 : std::min(kBack, runs[index - 1].count))
                 : end + std::min(kBack, runs[index + 1].count) - 1;
  const std::size_t to = has_after ? end : run.first - 1;
  for (std::size_t i = run.first; i < end; ++i)
    if (!lies_on_line(point(from), point(to), point(i), kOutlineToleranceM)) return false;
  return true;
}

}  // namespace

void split_by_label(std::span<const std::uint16_t> beams, const SegmentedScan& scan,
                    std::vector<Run>& runs) {
  runs.clear();
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const PointLabel label = scan.labels[beams[i]];
    if (label == PointLabel::kUnknown && runs.empty()) {
      ++unknown;
      continue;
    }
    const bool is_moving =
        label == PointLabel::kUnknown ? runs.back().is_moving : label == PointLabel::kMoving;
    if (runs.empty()) runs.push_back({0, unknown + 1, is_moving});
    else if (runs.back().is_moving == is_moving) ++runs.back().count;
    else runs.push_back({i, 1, is_moving});
  }
  if (runs.empty()) runs.push_back({0, beams.size(), false});
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].is_moving && continues_wall(i, runs, beams, scan)) runs[i].is_moving = false;
  merge_with_equal_neighbours(runs);
  for (int pass = 0; pass < 2 && runs.size() > 1; ++pass) {
    for (Run& run : runs) {
      const int least = run.is_moving ? kLeastMovingRun : kLeastStationaryRun;
      if (static_cast<int>(run.count) < least) run.is_moving = !run.is_moving;
    }
    merge_with_equal_neighbours(runs);
  }
}

}  // namespace slammot::detection
