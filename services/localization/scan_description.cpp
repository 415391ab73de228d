#include "services/localization/scan_description.hpp"

#include <algorithm>
#include <utility>

#include "common/sensing/turning_direction.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::Vector2;

constexpr std::size_t kRanges = 4;  // that are shared with the help

flow::LocalizedScan header_of(const ScanToDescribe& described) {
  flow::LocalizedScan localized;
  localized.stamp_ns = described.scan.stamp_ns;
  localized.sequence = described.scan.sequence;
  localized.scanner_id = described.scan.scanner.scanner_id;
  localized.base_from_laser = described.scan.scanner.base_from_laser;
  localized.max_range_m = described.scan.scanner.max_range_m;
  localized.beam_step_rad = described.scan.scanner.beam_step_rad;
  localized.sweep_s = described.sweep_s;
  localized.odom_from_base = described.odom_from_base;
  localized.map_from_odom = described.map_from_odom;
  localized.speed_mps = described.speed_mps;
  localized.yaw_rate_radps = described.yaw_rate_radps;
  localized.submap_id = described.map.submap_id();
  localized.submap_from_base =
      geometry::inverse(described.map.odom_from_submap()) * described.odom_from_base.pose;
  return localized;
}

Pose2 odom_from_laser(const ScanToDescribe& described) {
  return described.odom_from_base.pose * described.scan.scanner.base_from_laser;
}

/// Where an echo came from, in odom.
class EchoEnds {
 public:
  explicit EchoEnds(const ScanToDescribe& described)
      : points_in_base_m_(described.points.all_in_base_m()),
        base_m_(described.odom_from_base.pose.translation_m()),
        turn_(geometry::rotation(described.odom_from_base.pose.heading_rad)) {}
  Vector2 operator()(std::size_t beam) const { return base_m_ + turn_ * points_in_base_m_[beam]; }

 private:
  const std::vector<Vector2>& points_in_base_m_;
  Vector2 base_m_;
  geometry::Matrix2 turn_;
};

}  // namespace

flow::LocalizedScan ScanDescription::describe(const ScanToDescribe& described,
                                              flow::LocalizedScan workspace) {
  flow::LocalizedScan localized = header_of(described);
  localized.beams = std::move(workspace.beams);
  localized.beams.resize(described.scan.range_m.size());
  turn_beams(described.scan, odom_from_laser(described).heading_rad);
  described.map.evidence();  // what is still on its way into it comes first: then it only answers
  look_up_ends(described, localized);
  list_asked_beams(localized);
  look_up_ranges(described, localized);
  return localized;
}

void ScanDescription::turn_beams(const sensing::LaserScan& scan, double odom_from_laser_rad) {
  beams_in_odom_.resize(scan.range_m.size());
  sensing::TurningDirection beam_in_odom(
      odom_from_laser_rad + sensing::beam_angle_rad(scan.scanner, 0), scan.scanner.beam_step_rad);
  for (Vector2& beam : beams_in_odom_) beam = beam_in_odom.now(), beam_in_odom.advance();
}

void ScanDescription::look_up_ends(const ScanToDescribe& described,
                                   flow::LocalizedScan& localized) const {
  const sensing::LaserScan& scan = described.scan;
  const EchoEnds end_of(described);
  work::share_in_ranges(
      help_, localized.beams.size(), kRanges, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
          flow::LocalizedBeam& beam = localized.beams[i] = {};
          const bool has_echo = sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m) &&
                                scan.range_m[i] >= config_.echoes.min_range_m;
          beam.point_in_base_m = described.points.all_in_base_m()[i].cast<float>();
          beam.range_m = has_echo ? scan.range_m[i] : 0.0F;
          if (has_echo) described.map.look_up_end(end_of(i), beam);
        }
      });
}

void ScanDescription::look_up_ranges(const ScanToDescribe& described,
                                     flow::LocalizedScan& localized) const {
  const double max_range_m = described.scan.scanner.max_range_m;
  const EchoEnds end_of(described);
  const Vector2 origin_in_odom_m = odom_from_laser(described).translation_m();
  work::share_in_ranges(
      help_, asked_beams_.size(), kRanges, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
          const std::size_t beam = asked_beams_[i];
          const bool has_echo = localized.beams[beam].range_m > 0.0F;
          const Vector2 towards_m =
              has_echo ? end_of(beam) : origin_in_odom_m + max_range_m * beams_in_odom_[beam];
          localized.beams[beam].expected_range_m =
              described.map.expected_range_m(origin_in_odom_m, towards_m, max_range_m);
        }
      });
}

/// Those near which an echo contradicts the map: elsewhere nobody asks what the map expected, and
/// to tell it of all costs more than the match.
void ScanDescription::list_asked_beams(const flow::LocalizedScan& localized) {
  asked_beams_.clear();
  const std::size_t count = localized.beams.size();
  for (std::size_t i = 0, next = 0; i < count; ++i) {
    if (!config_.echoes.expects_all_ranges && localized.beams[i].end_cell != flow::EndCell::kFree)
      continue;
    const std::size_t end = std::min(i + flow::kExpectedAside + 1, count);
    for (next = std::max(next, i < flow::kExpectedAside ? 0 : i - flow::kExpectedAside); next < end;
         ++next)
      asked_beams_.push_back(next);
  }
}

}  // namespace slammot::localization
