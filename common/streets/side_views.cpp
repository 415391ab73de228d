#include "common/streets/side_views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
constexpr double kLookStep_m = 0.2;     // along a look
constexpr double kSideReach_m = 26.0;   // beyond houses at the building line: a street, or a gap
constexpr double kAheadReach_m = 45.0;  // the same beyond the junction in which the way turns
constexpr double kJudged_m = 14.0;      // of the reach: its last part must be seen
constexpr double kUnseenShare = 0.25;   // of that part
constexpr double kAheadHalfWidth_m = 9.0;
constexpr double kNodeBeside_m = 10.0;  // of the way: lane and errors of the graph
constexpr double kTurnsOff_rad = 0.7;   // least angle of a turn into another street
constexpr int kLeastWidth = 6;          // looks, a metre each: two lanes
constexpr int kMostWidth = 30;
constexpr int kBridged = 2;  // looks that a post hides
constexpr double kSameOpening_m = 8.0;

View look(const SeenSpace& seen, const Pose2& map_from_look, double reach_m) {
  int judged = 0;
  int unseen = 0;
  for (double at_m = 0.0; at_m < reach_m; at_m += kLookStep_m) {
    const Seen cell = seen.at(map_from_look * Vector2(at_m, 0.0));
    if (cell == Seen::kOccupied) return View::kClosed;
    if (at_m < reach_m - kJudged_m) continue;
    ++judged;
    if (cell == Seen::kUnknown) ++unseen;
  }
  return unseen <= kUnseenShare * judged ? View::kOpen : View::kUnknown;
}

Pose2 turned(const Vector2& place_m, double heading_rad) {
  return {place_m.x(), place_m.y(), geometry::wrap_angle(heading_rad)};
}

/// Points of the way, both included, that lie in one stretch.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<Stretch> straight_parts_of(const DrivenWay& way) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < way.points.size(); ++i) {
    if (way.stretches[i] == DrivenWay::kTurn) continue;
    const bool goes_on = i > 0 && way.stretches[i - 1] == way.stretches[i];
    if (goes_on) stretches.back().last = i;
    else stretches.push_back({i, i});
  }
  return stretches;
}

ViewFan fan_to_side(const SeenSpace& seen, const DrivenWay& way, const Stretch& stretch,
                    double side_rad) {
  ViewFan fan{{}, {}, true, -kNodeBeside_m, kNodeBeside_m};
  for (std::size_t i = stretch.first; i < stretch.last; ++i) {
    const Vector2 from_m = way.points[i].translation_m();
    const Vector2 along_m = way.points[i + 1].translation_m() - from_m;
    const double direction_rad = std::atan2(along_m.y(), along_m.x()) + side_rad;
    const int looks = std::max(1, static_cast<int>(std::lround(along_m.norm())));
    for (int k = 0; k < looks; ++k)
      fan.looks.push_back(turned(from_m + along_m * k / looks, direction_rad));
  }
  for (const Pose2& one : fan.looks) fan.views.push_back(look(seen, one, kSideReach_m));
  return fan;
}

ViewFan fan_ahead(const SeenSpace& seen, const Pose2& map_from_end) {
  ViewFan fan{{}, {}, false, 0.0, kAheadReach_m - kNodeBeside_m};
  for (double left_m = -kAheadHalfWidth_m; left_m <= kAheadHalfWidth_m; left_m += 1.0) {
    fan.looks.push_back(turned(map_from_end * Vector2(0.0, left_m), map_from_end.heading_rad));
    fan.views.push_back(look(seen, fan.looks.back(), kAheadReach_m));
  }
  return fan;
}

Pose2 backwards(const Pose2& pose) {
  return turned(pose.translation_m(), pose.heading_rad + std::numbers::pi);
}

/// Runs of open looks; what is cut by the end of the fan has no known middle.
void append_openings(const ViewFan& fan, std::vector<Opening>& openings) {
  const int count = static_cast<int>(fan.views.size());
  int first = -1;
  int last = -1;
  const auto close = [&] {
    const int width = last - first + 1;
    const bool is_whole = first > 0 && last + 1 < count;
    if (first >= 0 && width >= kLeastWidth && width <= kMostWidth && is_whole) {
      const Pose2& middle = fan.looks[static_cast<std::size_t>((first + last) / 2)];
      openings.push_back({middle, fan.nearest_m, fan.farthest_m});
    }
    first = last = -1;
  };
  for (int i = 0; i < count; ++i) {
    if (fan.views[static_cast<std::size_t>(i)] == View::kOpen) {
      if (first < 0) first = i;
      last = i;
    } else if (first >= 0 && i - last > kBridged) {
      close();
    }
  }
  close();
}

bool are_one(const Opening& a, const Opening& b) {
  const Vector2 b_in_a_m = geometry::inverse(a.map_from_look) * b.map_from_look.translation_m();
  const double turn_rad =
      geometry::wrap_angle(a.map_from_look.heading_rad - b.map_from_look.heading_rad);
  return std::abs(turn_rad) < 0.5 * kQuarter_rad && std::abs(b_in_a_m.y()) < kSameOpening_m &&
         std::abs(b_in_a_m.x()) < 4.0 * kSameOpening_m;
}

}  // namespace

std::vector<ViewFan> side_views(const SeenSpace& seen, const DrivenWay& way) {
  std::vector<ViewFan> fans;
  if (seen.cells.empty()) return fans;
  const std::vector<Stretch> stretches = straight_parts_of(way);
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    for (const double side_rad : {kQuarter_rad, -kQuarter_rad})
      fans.push_back(fan_to_side(seen, way, stretches[i], side_rad));
    if (i + 1 == stretches.size()) break;
    const Pose2& before = way.points[stretches[i].last];
    const Pose2& after = way.points[stretches[i + 1].first];
    const double turn_rad = geometry::wrap_angle(after.heading_rad - before.heading_rad);
    if (std::abs(turn_rad) < kTurnsOff_rad) continue;
    fans.push_back(fan_ahead(seen, before));
    fans.push_back(fan_ahead(seen, backwards(after)));
  }
  return fans;
}

std::vector<Opening> openings_of(const std::vector<ViewFan>& fans) {
  std::vector<Opening> all;
  for (const ViewFan& fan : fans) {
    if (fan.is_to_side) append_openings(fan, all);
  }
  std::vector<Opening> openings;
  for (const Opening& one : all) {
    const bool is_new =
        std::ranges::none_of(openings, [&](const Opening& known) { return are_one(known, one); });
    if (is_new) openings.push_back(one);
  }
  return openings;
}

}  // namespace slammot::streets
