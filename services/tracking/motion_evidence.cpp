#include "services/tracking/motion_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::tracking {
namespace {

using Eigen::Vector2d;

constexpr double kStoodIfSliding = 0.3;  ///< Weight of an echo that stood but may lie on a flank
                                         ///< that slides along itself.

/// True if the echo lies on a side along the motion of a slow box: there a moving object looks as
/// if it stood.
bool slides_along_itself(std::uint16_t beam, const Track& track, const ScanView& view) {
  constexpr double kSlowMps = 3.0;  // a faster flank leaves its place
  constexpr int kBeamsAside = 2;
  constexpr double kCosine = 0.9;
  if (track.extent.box() == nullptr || track.velocity_mps().norm() > kSlowMps) return false;
  const std::size_t segment = view.segment_of_beam(beam);
  const auto is_beside = [&](int neighbour) {
    return neighbour >= 0 && neighbour < static_cast<int>(view.polar().beam_count()) &&
           view.segment_of_beam(static_cast<std::size_t>(neighbour)) == segment;
  };
  int low = beam;
  int high = beam;
  for (int i = 1; i <= kBeamsAside; ++i) {
    if (is_beside(beam - i)) low = beam - i;
    if (is_beside(beam + i)) high = beam + i;
  }
  const Vector2d side = view.point_in_odom_m(static_cast<std::size_t>(high)) -
                        view.point_in_odom_m(static_cast<std::size_t>(low));
  const Vector2d along{std::cos(track.footprint().heading_rad),
                       std::sin(track.footprint().heading_rad)};
  return std::abs(side.dot(along)) > kCosine * side.norm() && side.squaredNorm() > 0.0;
}

double stood_weight(std::uint16_t beam, const Track& track, const ScanView& view) {
  return slides_along_itself(beam, track, view) ? kStoodIfSliding : 1.0;
}

/// Against the usual earlier scan.
MotionEvidence evidence_by_comparison(const Track& track, const std::vector<std::uint16_t>& beams,
                                      const ComparedScan& context) {
  MotionEvidence evidence;
  for (const std::uint16_t beam : beams) {
    const Past past = context.comparison.beam(beam);
    if (past == Past::kStood) evidence.stood += stood_weight(beam, track, context.view);
    evidence.moved += past == Past::kArrived || past == Past::kAppeared ? 1.0 : 0.0;
    evidence.undecided += past == Past::kUnknown ? 1.0 : 0.0;
  }
  return evidence;
}

/// What the echo of a beam says against this earlier scan.
Past past_of(std::uint16_t beam, const EarlierScan& then, bool is_usual,
             const ComparedScan& context) {
  // A stationary wall that answers now and then appears, too.
  const TrackingConfig& config = context.config;
  const bool may_appear = only_people_move(config) &&
                          context.scan().segments[context.view.segment_of_beam(beam)].box_length_m <
                              config.extent.stride_m;
  const bool is_compared =
      context.comparison.has_shifted(beam) || (is_usual && !only_people_move(config));
  return is_compared ? context.comparison.beam(beam)
                     : context.history.past_of(beam, context.view.polar(), then, may_appear);
}

/// Echoes at places that the earlier scan saw through, and echoes of the earlier scan at places
/// that this one sees through, say that the object has moved.
MotionEvidence evidence_against(const EarlierScan& then, const Track& track,
                                const std::vector<std::uint16_t>& beams,
                                const ComparedScan& context) {
  MotionEvidence evidence;
  const bool is_usual =
      &then == context.history.older_than(context.scan().stamp_ns, kCompareAfterS);
  for (const std::uint16_t beam : beams) {
    const Past past = past_of(beam, then, is_usual, context);
    const bool has_stayed = context.comparison.beam(beam) == Past::kStood;  // since it came into
                                                                            // view
    if (past == Past::kArrived || (past == Past::kAppeared && !has_stayed)) evidence.moved += 1.0;
    else if (past == Past::kStood || past == Past::kAppeared)
      evidence.stood += stood_weight(beam, track, context.view);
    else evidence.undecided += 1.0;
  }
  if (then.stamp_ns < track.history.first_seen_ns) return evidence;  // it had no echoes then
  for (std::size_t beam = 0; beam < then.owners.size(); ++beam) {
    if (!then.owners[beam].is_owned || then.owners[beam].track_id != track.track_id) continue;
    if (context.view.polar().sight_of(then.view.point_in_odom_m(beam)).sight == Sight::kThrough)
      evidence.moved += 1.0;
  }
  return evidence;
}

}  // namespace

MotionEvidence motion_evidence(const Track& track, const std::vector<std::uint16_t>& beams,
                               const ComparedScan& context) {
  if (track.existence.confirmed) return evidence_by_comparison(track, beams, context);
  MotionEvidence best;
  double best_share = -1.0;
  for (const double age_s : {kCompareFastAfterS, kCompareAfterS, kCompareSlowAfterS}) {
    const EarlierScan* then = context.history.older_than(context.scan().stamp_ns, age_s);
    if (then == nullptr) continue;
    const MotionEvidence evidence = evidence_against(*then, track, beams, context);
    const double share = evidence.moved / std::max(1.0, evidence.moved + evidence.stood);
    if (share > best_share) best_share = share, best = evidence;
  }
  return best;
}

TentativeEvidence with_echoes(TentativeEvidence tentative, const std::vector<std::uint16_t>& beams,
                              const ComparedScan& context) {
  for (const std::uint16_t beam : beams) {
    tentative.seen += 1.0;
    tentative.in_free_space += context.scan().labels[beam] == flow::PointLabel::kMoving ? 1.0 : 0.0;
    tentative.stood += context.comparison.beam(beam) == Past::kStood ? 1.0 : 0.0;
  }
  return tentative;
}

}  // namespace slammot::tracking
