#include "common/sensing/segmentation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <Eigen/Geometry>

#include "common/geometry/full_turn.hpp"

namespace slammot::sensing {
namespace {

// Multiples of gap_m.
constexpr double kWidestGap = 5.0;      ///< At any range,
constexpr double kLineGap = 20.0;       ///< on a straight wall at grazing incidence,
constexpr double kDarkGap = 5.0;        ///< and between single echoes of a dark object on a line.
constexpr double kOffLine = 5.0 / 6.0;  ///< Allowed distance of an echo from the line of its wall.

constexpr double kGapBeamSpacings = 3.0;  ///< Growth of the gap with the beam spacing at the range.
constexpr float kLineGapGrowth = 2.5F;    ///< Largest ratio of neighbouring gaps on a wall.
constexpr int kBridgedBeams = 2;          ///< Drop-outs between two echoes of a segment,
constexpr int kDarkGapBeams = 12;         ///< and between two single echoes of a dark object.

/// Echoes at one end of a span: the last, the one before it, and one a few echoes further in.
struct Tip {
  Eigen::Vector2f end_m;
  Eigen::Vector2f next_m;
  Eigen::Vector2f inner_m;
  bool is_line = false;  ///< True if the three echoes differ.
};

/// step +1: end with the highest beam; -1: end with the lowest.
Tip tip_of(const BeamSpan& span, int step, std::span<const Eigen::Vector2f> points_m,
           std::span<const float> range_m) {
  constexpr int kEchoesLookedAt = 5;
  Tip tip;
  int found = 0;
  int beam = step > 0 ? span.last : span.first;
  for (; beam >= span.first && beam <= span.last && found < kEchoesLookedAt; beam -= step) {
    const auto index = static_cast<std::size_t>(beam);
    if (range_m[index] <= 0.0F) continue;
    if (found == 0) tip.end_m = points_m[index];
    if (found == 1) tip.next_m = points_m[index];
    tip.inner_m = points_m[index];
    ++found;
  }
  tip.is_line = found >= 3;
  return tip;
}

bool goes_on_at(const Tip& tip, const Eigen::Vector2f& point_m, const SegmentationConfig& config) {
  if (!tip.is_line) return false;
  const Eigen::Vector2f gap = point_m - tip.end_m;
  const float widest_m = std::min(static_cast<float>(kLineGap * config.gap_m),
                                  kLineGapGrowth * (tip.end_m - tip.next_m).norm());
  const Eigen::Vector2f direction = (tip.end_m - tip.inner_m).normalized();
  const float along_m = direction.dot(gap);
  const float across_m = direction.x() * gap.y() - direction.y() * gap.x();
  return along_m > 0.0F && along_m <= widest_m &&
         std::abs(across_m) <= static_cast<float>(kOffLine * config.gap_m);
}

void join_along_lines(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m,
                      const SegmentationConfig& config, std::vector<BeamSpan>& spans) {
  const auto are_near = [&](const BeamSpan& a, const BeamSpan& b) {
    return b.first - a.last <= kBridgedBeams + 1;
  };
  std::size_t kept = 0;
  for (std::size_t i = 1; i < spans.size(); ++i) {
    if (are_near(spans[kept], spans[i]) &&
        goes_on_at(tip_of(spans[kept], +1, points_m, range_m), points_m[spans[i].first], config))
      spans[kept].last = spans[i].last;
    else spans[++kept] = spans[i];
  }
  if (!spans.empty()) spans.resize(kept + 1);
  std::reverse(spans.begin(), spans.end());
  kept = 0;
  for (std::size_t i = 1; i < spans.size(); ++i) {
    if (are_near(spans[i], spans[kept]) &&
        goes_on_at(tip_of(spans[kept], -1, points_m, range_m), points_m[spans[i].last], config))
      spans[kept].first = spans[i].first;
    else spans[++kept] = spans[i];
  }
  if (!spans.empty()) spans.resize(kept + 1);
  std::reverse(spans.begin(), spans.end());
}

/// True if all echoes between the two beams lie on the line through the outermost ones.
bool are_on_a_line(std::uint16_t first, std::uint16_t last,
                   std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m,
                   double tolerance_m) {
  const Eigen::Vector2f direction = (points_m[last] - points_m[first]).normalized();
  for (std::size_t beam = first + 1U; beam < last; ++beam) {
    if (range_m[beam] <= 0.0F) continue;
    const Eigen::Vector2f off_m = points_m[beam] - points_m[first];
    if (std::abs(direction.x() * off_m.y() - direction.y() * off_m.x()) >
        static_cast<float>(tolerance_m))
      return false;
  }
  return true;
}

/// True if all beams between neighbouring spans are drop-outs.
void join_what_is_dark(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m,
                       const SegmentationConfig& config, std::vector<BeamSpan>& spans) {
  constexpr int kMostInARow = 3;  // a bright surface returns longer runs of echoes
  constexpr std::size_t kFewestSpans = 3;
  constexpr double kMostInARowInTheMean = 1.9;  // pedestrians abreast return longer runs of echoes
  constexpr double kMostAnsweredShare = 0.5;
  const double dark_gap_m = kDarkGap * config.gap_m;
  const auto is_short = [](const BeamSpan& span) { return span.last - span.first < kMostInARow; };
  const auto may_follow = [&](const BeamSpan& a, const BeamSpan& b) {
    return b.first - a.last <= kDarkGapBeams + 1 && is_short(b) &&
           (points_m[b.first] - points_m[a.last]).squaredNorm() <=
               static_cast<float>(dark_gap_m * dark_gap_m);
  };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < spans.size();) {
    std::size_t end = i + 1;
    int answered = spans[i].last - spans[i].first + 1;
    while (is_short(spans[i]) && end < spans.size() && may_follow(spans[end - 1], spans[end]) &&
           are_on_a_line(spans[i].first, spans[end].last, points_m, range_m,
                         kOffLine * config.gap_m)) {
      answered += spans[end].last - spans[end].first + 1;
      ++end;
    }
    const std::size_t count = end - i;
    const bool is_dark = count >= kFewestSpans &&
                         answered <= kMostInARowInTheMean * static_cast<double>(count) &&
                         answered < kMostAnsweredShare * (spans[end - 1].last - spans[i].first + 1);
    if (is_dark) spans[kept++] = {spans[i].first, spans[end - 1].last};
    else
      for (std::size_t j = i; j < end; ++j) spans[kept++] = spans[j];
    i = end;
  }
  spans.resize(kept);
}

bool lie_together(std::size_t before, std::size_t beam, std::span<const Eigen::Vector2f> points_m,
                  std::span<const float> range_m, double beam_step_rad,
                  const SegmentationConfig& config) {
  const double spacing_m =
      std::abs(beam_step_rad) * static_cast<double>(std::max(range_m[before], range_m[beam]));
  const double gap_m =
      std::min(kWidestGap * config.gap_m, config.gap_m + kGapBeamSpacings * spacing_m);
  return (points_m[beam] - points_m[before]).squaredNorm() <= static_cast<float>(gap_m * gap_m);
}

}  // namespace

void segment_by_distance(std::span<const Eigen::Vector2f> points_m, std::span<const float> range_m,
                         double beam_step_rad, const SegmentationConfig& config,
                         std::vector<BeamSpan>& spans) {
  assert(points_m.size() == range_m.size());
  spans.clear();
  for (std::size_t beam = 0; beam < range_m.size(); ++beam) {
    if (range_m[beam] <= 0.0F) continue;
    const auto index = static_cast<std::uint16_t>(beam);
    const bool goes_on =
        !spans.empty() && index - spans.back().last <= kBridgedBeams + 1 &&
        lie_together(spans.back().last, beam, points_m, range_m, beam_step_rad, config);
    if (goes_on) spans.back().last = index;
    else spans.push_back({index, index});
  }
  join_along_lines(points_m, range_m, config, spans);
  if (kDarkGapBeams > 0) join_what_is_dark(points_m, range_m, config, spans);
}

bool continues_across_seam(std::span<const Eigen::Vector2f> points_m,
                           std::span<const float> range_m, double beam_step_rad,
                           const SegmentationConfig& config, std::span<const BeamSpan> spans) {
  if (spans.size() < 2 || !geometry::goes_all_round(range_m.size(), beam_step_rad)) return false;
  const std::size_t last = spans.back().last;
  const std::size_t first = spans.front().first;
  const std::size_t unanswered = range_m.size() - 1 - last + first;
  return static_cast<int>(unanswered) <= kBridgedBeams &&
         lie_together(last, first, points_m, range_m, beam_step_rad, config);
}

}  // namespace slammot::sensing
