#include "services/tracking/scan_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "services/tracking/association_cost.hpp"
#include "services/tracking/face_shift.hpp"

namespace slammot::tracking {
namespace {

using flow::PointLabel;
using flow::Segment;

/// True if the segment may be a vehicle that has come and stands now. Mapped structure is excluded:
/// there a wall is likelier than a correct track.
bool may_have_come(const Segment& segment, const TrackingConfig& config) {
  const bool may_be_vehicle =
      segment.label == PointLabel::kMoving || segment.label == PointLabel::kUnknown;
  return !only_people_move(config) && may_be_vehicle &&
         segment.box_length_m <= config.extent.longest_body_m;
}

/// Most neighbouring echoes that have arrived since.
int longest_arrival_since(const EarlierScan& then, const Segment& segment, const PolarView& now) {
  int longest = 0;
  int run = 0;
  for (const std::uint16_t beam : segment.beams) {
    run = then.view.sight_of(now.point_in_odom_m(beam)).sight == Sight::kThrough ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

bool is_change(Past past) { return past == Past::kArrived || past == Past::kAppeared; }

/// Echoes with one in the earlier scan at their place, and those where that was of a vehicle that
/// has come.
struct SeenBefore {
  int echoes = 0;
  int of_vehicles = 0;
};

void judge(SegmentComparison& comparison, const Segment& segment, const SeenBefore& seen,
           const TrackingConfig& config) {
  constexpr double kLeastStoodShare = 0.6;
  constexpr double kLeastStoodIfMapped = 0.25;   // the mapped structure may be older than a vehicle
                                                 // that drives there
  constexpr double kLeastChangedShare = 0.3;     // with more change the map is not believed
  constexpr double kLeastComeShareOfSeen = 0.6;  // of the echoes that have one in the earlier scan,
  constexpr double kLeastComeShare = 0.3;        // and of all: more of a vehicle comes into view in
                                                 // passing
  constexpr double kMostMovingShare = 0.2;       // of the echoes that contradict the map, for the
                                                 // segment to be mapped
  const auto count = static_cast<double>(segment.beams.size());
  const bool is_mapped =
      segment.label == PointLabel::kStationary && segment.moving_share < kMostMovingShare;
  comparison.stood_before = comparison.stood > kLeastStoodShare * count;
  comparison.stands = comparison.stood_before ||
                      (is_mapped && comparison.stood > kLeastStoodIfMapped * count &&
                       comparison.arrived + comparison.receded < kLeastChangedShare * count);
  comparison.has_come = may_have_come(segment, config) &&
                        seen.of_vehicles > kLeastComeShareOfSeen * seen.echoes &&
                        seen.of_vehicles > kLeastComeShare * count;
}

}  // namespace

bool may_have_flank(const Segment& segment, const TrackingConfig& config) {
  constexpr double kShortestFlankM = 2.5;
  return segment.box_length_m > kShortestFlankM * config.extent.size_scale &&
         segment.box_length_m < config.extent.longest_body_m;
}

EarlierScans earlier_scans(const ScanContext& context) {
  const TrackingConfig& config = context.config;
  const auto older_than = [&](double age_s) {
    return context.history.older_than(context.scan().stamp_ns, age_s);
  };
  EarlierScans earlier;
  earlier.usual = older_than(kCompareAfterS);
  earlier.recent = only_people_move(config) ? older_than(kCompareFastAfterS) : nullptr;
  earlier.distant = older_than(kCompareSlowAfterS);
  if (only_people_move(config)) return earlier;
  for (const double age_s : kFaceAgesS)
    if (const EarlierScan* then = older_than(age_s); then != nullptr)
      earlier.for_faces[earlier.count_for_faces++] = then;
  return earlier;
}

void ScanComparison::begin(const ScanContext& context) {
  beams_.assign(context.scan().range_m.size(), Past::kUnknown);
  segments_.assign(context.scan().segments.size(), {});
  has_shifted_.assign(context.scan().range_m.size(), false);
  earlier_ = earlier_scans(context);
}

/// Writes the segment and its own beams only.
void ScanComparison::compare(std::size_t index, const ScanContext& context) {
  compare_face(index, context);
  const ScanView& view = context.view;
  const Segment& segment = view.scan().segments[index];
  SegmentComparison comparison = segments_[index];
  int arrival = 0;
  SeenBefore seen;
  for (const std::uint16_t beam : segment.beams) {
    if (earlier_.usual == nullptr) break;
    const SightOfPlace before = earlier_.usual->view.sight_of(view.point_in_odom_m(beam));
    if (before.sight == Sight::kThere) {
      ++seen.echoes;
      seen.of_vehicles += earlier_.usual->owners[before.beam].has_come ? 1 : 0;
    }
    const Past of_beam = has_shifted(beam)
                             ? Past::kArrived
                             : context.history.past_of(beam, before, view.polar(), *earlier_.usual,
                                                       only_people_move(context.config));
    beams_[beam] = of_beam;
    comparison.stood += of_beam == Past::kStood ? 1 : 0;
    comparison.arrived += of_beam == Past::kArrived ? 1 : 0;
    comparison.receded += of_beam == Past::kReceded ? 1 : 0;
    const bool is_open = of_beam == Past::kUnknown && earlier_.recent != nullptr;  // e.g. hidden by
                                                                                   // a pedestrian
                                                                                   // ahead
    comparison.came +=
        is_change(is_open ? context.history.past_of(beam, view.polar(), *earlier_.recent, true)
                          : of_beam)
            ? 1
            : 0;
    arrival = of_beam == Past::kArrived ? arrival + 1 : 0;
    comparison.longest_arrival = std::max(comparison.longest_arrival, arrival);
  }
  if (segment.label != PointLabel::kMoving && may_have_flank(segment, context.config) &&
      earlier_.distant != nullptr)
    comparison.longest_arrival =
        std::max(comparison.longest_arrival,
                 longest_arrival_since(*earlier_.distant, segment, view.polar()));
  judge(comparison, segment, seen, context.config);
  segments_[index] = comparison;
}

/// Measures the displacement of the segment's front or rear. Of a face whose middle is hidden,
/// another segment may be the other end.
void ScanComparison::compare_face(std::size_t index, const ScanContext& context) {
  constexpr double kLongestPieceM = 1.2;
  constexpr std::size_t kSegmentsAside = 2;  // the occluder between two pieces is a segment itself
  const TrackingConfig& config = context.config;
  if (only_people_move(config)) return;
  const std::vector<Segment>& segments = context.scan().segments;
  const Segment& segment = segments[index];
  if (segment.label == PointLabel::kNoEcho || segment.box_length_m > config.extent.longest_body_m)
    return;
  const std::span<const EarlierScan* const> earlier(earlier_.for_faces.data(),
                                                    earlier_.count_for_faces);
  const auto pose_sigma_m = [&] {
    return std::sqrt(pose_covariance_at(segment.centroid_in_odom_m, context.scan()).trace());
  };
  const auto may_be_piece = [&](const Segment& one) {
    return one.label != PointLabel::kNoEcho &&
           one.box_length_m < kLongestPieceM * config.extent.size_scale;
  };
  std::optional<FaceShift> shift =
      face_shift(segment.beams, context.view.polar(), earlier, pose_sigma_m, config);
  const std::size_t end =
      may_be_piece(segment) ? std::min(segments.size(), index + kSegmentsAside + 1) : 0;
  for (std::size_t other = index - std::min(index, kSegmentsAside); !shift && other < end; ++other)
    if (other != index && may_be_piece(segments[other]))
      shift = face_shift_with(segments[other].beams, segment.beams, context.view.polar(), earlier,
                              pose_sigma_m, config);
  if (!shift) return;
  segments_[index].face_shift_m = shift->shift_m;
  for (const std::uint16_t beam : shift->beams) has_shifted_[beam] = true;
}

}  // namespace slammot::tracking
