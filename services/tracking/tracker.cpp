#include "services/tracking/tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "common/association/assignment.hpp"
#include "common/sensing/box_fit.hpp"
#include "services/tracking/merging.hpp"
#include "services/tracking/face_shift.hpp"
#include "services/tracking/association_cost.hpp"
#include "services/tracking/confirmation.hpp"
#include "services/tracking/existence_score.hpp"
#include "services/tracking/extent_update.hpp"
#include "services/tracking/measurement_update.hpp"
#include "services/tracking/publication.hpp"
#include "services/tracking/road_user_learning.hpp"
#include "services/tracking/termination.hpp"
#include "services/tracking/track_initiation.hpp"
#include "services/tracking/speed_evidence.hpp"
#include "services/tracking/refiltering.hpp"

namespace slammot::tracking {
namespace {

using association::kUnassigned;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

constexpr double kNanosecond_s = 1e-9;

std::int64_t nanoseconds(double time_s) { return std::llround(time_s / kNanosecond_s); }

constexpr std::size_t kMostPastScans = 64;
constexpr double kFastestOfSigmas = 1.25;   ///< No speed beyond so many times the largest that is likely is looked for.

constexpr double kLeastStoodShare = 0.6;   ///< Of a segment's echoes that were there before, for it to stand.
constexpr double kLeastStoodIfMapped = 0.25;  ///< The same where the map has something, too: it may be older than what drives there.
constexpr double kLeastChangedShare = 0.3; ///< Of them that came or went, for the map not to be believed.
constexpr double kStoodIfSliding = 0.3;    ///< What an echo that stood counts if it may lie on a flank that slides along itself.
constexpr double kLeastComeShareOfSeen = 0.6;  ///< Of a segment's echoes that were seen before those of a vehicle, for it to have come,
constexpr double kLeastComeShare = 0.3;        ///< and of all of them: as one drives past, more of it comes into view.
constexpr double kMostMovingShare = 0.2;   ///< Of a segment's echoes that contradict the map, for it to stand.

bool is_slow(const Track& track) { return track.velocity_mps().norm() < 1.5; }

bool may_have_a_flank(const Segment& segment, const TrackingConfig& config) {
  constexpr double kShortestFlankM = 2.5;
  return segment.box_length_m > kShortestFlankM * config.size_scale && segment.box_length_m < config.longest_body_m;
}

/// Whether the segment may be of a vehicle that has come and stands now: if most of what was seen of it in an earlier scan, too,
/// was of one. What the map holds is not asked: there a wall is likelier than a track that is right.
bool may_have_come(const Segment& segment, const TrackingConfig& config) {
  const bool may_be_vehicle = segment.label == PointLabel::kMoving || segment.label == PointLabel::kUnknown;
  return !only_people_move(config) && may_be_vehicle && segment.box_length_m <= config.longest_body_m;
}

/// Most echoes side by side that have arrived since.
int longest_arrival_since(const EarlierScan& then, const Segment& segment, const PolarView& now) {
  int longest = 0;
  int run = 0;
  for (const std::uint16_t beam : segment.beams) {
    run = then.view.sight_of(now.point_in_odom_m(beam)).sight == Sight::kThrough ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

PointLabel stronger(PointLabel a, PointLabel b) {
  for (const PointLabel label : {PointLabel::kMoving, PointLabel::kStationary})
    if (a == label || b == label) return label;
  return PointLabel::kUnknown;
}

/// How far into the body's neighbourhood a point may lie and still be the body's.
double margin_of(const Track& track, const TrackingConfig& config) {
  const double sigma_m = std::sqrt(0.5 * track.kinematics.position_covariance_m2().trace());
  return config.gate_margin_m + std::min(1.0, sigma_m);
}

void add_beams(std::vector<std::uint16_t>& beams, const std::vector<std::uint16_t>& more) {
  beams.insert(beams.end(), more.begin(), more.end());
  std::sort(beams.begin(), beams.end());
}

/// Of its echoes, in the mean.
double distance_from_sides_m(const Segment& segment, const ScanView& view) {
  const sensing::BoxSides sides(sensing::OrientedBox{segment.box_centre_in_odom_m, segment.box_heading_rad, segment.box_length_m, segment.box_width_m});
  double sum_m = 0.0;
  for (const std::uint16_t beam : segment.beams) sum_m += sides.distance_m(view.point_in_odom_m(beam));
  return sum_m / static_cast<double>(segment.beams.size());
}

/// The long side, if the beams are mostly those of one moving segment with one.
std::optional<Side> side_of(const std::vector<std::uint16_t>& beams, const ScanView& view, double least_length_m) {
  const Segment& segment = view.scan().segments[view.segment_of_beam(beams[beams.size() / 2])];
  constexpr std::size_t kFewestEchoes = 6;
  if (segment.beams.size() < kFewestEchoes || segment.box_length_m < least_length_m || 2 * segment.beams.size() < beams.size()) return std::nullopt;
  const bool is_line = segment.box_width_m < 0.1 * segment.box_length_m;
  if (segment.label != PointLabel::kMoving && !is_line) return std::nullopt;  // no heading was searched for
  return Side{segment.box_heading_rad, segment.box_length_m, distance_from_sides_m(segment, view)};
}

/// Where beams that are ascending but for one step across the seam of the scan begin, and the first and the last of them, with
/// nothing but the thing that they met in between.
struct Ends {
  std::size_t start = 0;      ///< Index of the first.
  std::uint16_t first = 0;
  std::uint16_t last = 0;
};

/// They begin after the widest gap.
Ends ends_of(const std::vector<std::uint16_t>& beams, const PolarView& view) {
  if (!view.goes_all_round()) return {0, beams.front(), beams.back()};
  std::size_t start = 0;
  std::size_t widest = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::size_t gap = view.steps_between(beams[i == 0 ? beams.size() - 1 : i - 1], beams[i]);
    if (gap > widest) start = i, widest = gap;
  }
  return {start, beams[start], beams[start == 0 ? beams.size() - 1 : start - 1]};
}

/// How many beams between the first and the last got no echo.
int gaps_between(const std::vector<std::uint16_t>& beams, const PolarView& view) {
  const Ends ends = ends_of(beams, view);
  const std::size_t steps = view.steps_between(ends.first, ends.last);
  int gaps = 0;
  for (std::size_t i = 1; i < steps; ++i) gaps += view.range_m(*view.neighbour_of(ends.first, static_cast<long>(i))) <= 0.0 ? 1 : 0;
  return gaps;
}

/// The time to which a body's echoes are moved, and how fast it goes.
struct SweptMotion {
  double time_offset_s = 0.0;
  Vector2d velocity_mps = Vector2d::Zero();
};

SweptMotion swept_motion(const Track& track) { return {track.kinematics.time_offset_s, track.velocity_mps()}; }

/// The points of some beams, with what lies beside them.
Observation observation_of(const std::vector<std::uint16_t>& beams, const SweptMotion& motion, const ResponseRate& responses, const ScanView& view, double size_scale,
                   std::vector<Vector2d>& points_m) {
  constexpr double kLongSideM = 1.4;
  points_m.clear();
  const Ends ends = ends_of(beams, view.polar());
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const std::uint16_t beam = beams[(ends.start + i) % beams.size()];
    points_m.push_back(view.point_in_odom_m(beam) - (view.polar().delay_s(beam) - motion.time_offset_s) * motion.velocity_mps);
  }
  return {points_m, view.laser_in_odom_m(), view.beam_step_rad(), edge_beyond(view, ends.first, -1, size_scale),
          edge_beyond(view, ends.last, +1, size_scale), side_of(beams, view, kLongSideM * size_scale), responses.unanswered_share()};
}

/// To when the beam that points at it is fired, in a scan that begins time_s after the one before; not back to before the beam
/// of another scanner that met it last.
void predict_to_its_beam(Track& track, double time_s, const PolarView& view, const TrackingConfig& config) {
  const double before_s = track.kinematics.time_offset_s;
  const double beam_s = view.delay_towards_s(track.position_m() + (time_s - before_s) * track.velocity_mps());
  track.kinematics.time_offset_s = std::max(beam_s, before_s - time_s);
  predict(track, std::max(0.0, time_s + track.kinematics.time_offset_s - before_s), config);
  track.history.since_in_view_s += time_s;
}

/// Whether the beams between two things see past them.
bool is_seen_between(const std::vector<std::uint16_t>& a, const std::vector<std::uint16_t>& b, const PolarView& view) {
  constexpr double kBeyondM = 0.7;
  constexpr int kMost = 1;
  Ends before = ends_of(a, view);
  Ends after = ends_of(b, view);
  const auto begins_within = [&](const Ends& one, const Ends& other) {
    return view.steps_between(other.first, one.first) <= view.steps_between(other.first, other.last);
  };
  if (begins_within(before, after) || begins_within(after, before)) return false;
  if (view.steps_between(before.last, after.first) > view.steps_between(after.last, before.first)) std::swap(before, after);
  const std::size_t steps = view.steps_between(before.last, after.first);
  const double farther_m = std::max(view.range_m(before.last), view.range_m(after.first));
  int beyond = 0;
  for (std::size_t i = 1; i < steps; ++i)
    beyond += view.range_m(*view.neighbour_of(before.last, static_cast<long>(i))) > farther_m + kBeyondM ? 1 : 0;
  return beyond > kMost;
}

bool is_long_known(const Track& track) {
  constexpr int kLongKnownHits = 10;
  return track.existence.confirmed && track.existence.hits >= kLongKnownHits;
}

}  // namespace

Tracker::Tracker(const TrackingConfig& config, work::SideWork* help) : config_(config), help_(help), competing_tracks_(config), formations_(config) {}

/// Whether the segment stands, and was not the track's own a moment ago: no part of something that moves.
bool Tracker::is_of_another_past(std::size_t segment, std::size_t track, const ScanView& view) const {
  // Of what creeps much slides along itself, and seems to stand; who walks has no flank that does.
  const bool may_slide = tracks_[track].extent.box() != nullptr || !tracks_[track].existence.confirmed;
  if (!past_of_segment_[segment].stands || (may_slide && is_slow(tracks_[track]))) return false;
  const EarlierScan* then = history().older_than(view.scan().stamp_ns, 0.0);
  if (then == nullptr) return false;
  const std::vector<std::uint16_t>& beams = view.scan().segments[segment].beams;
  constexpr std::size_t kMostAsked = 7;
  const std::size_t stride = 1 + (beams.size() - 1) / kMostAsked;
  int asked = 0;
  int own = 0;
  for (std::size_t i = 0; i < beams.size(); i += stride) {
    const SightOfPlace before = then->view.sight_of(view.point_in_odom_m(beams[i]));
    ++asked;
    if (before.sight != Sight::kThere) continue;
    const Owner& owner = then->owners[before.beam];
    own += owner.is_owned && owner.track_id == tracks_[track].track_id ? 1 : 0;
  }
  return 2 * own < asked;
}

/// Whether the ends and the middle of the segment lie in the track's body.
bool Tracker::lies_in_body(const Segment& segment, const Track& track, const ScanView& view) const {
  if (segment.box_length_m > track.footprint().length.value_m + config_.gate_margin_m) return false;
  const double margin_m = margin_of(track, config_);
  const auto contains = [&](const Vector2d& point_m) { return is_inside(track.footprint(), track.position_m(), margin_m, point_m); };
  return contains(segment.centroid_in_odom_m) && contains(view.point_in_odom_m(segment.beams.front())) &&
         contains(view.point_in_odom_m(segment.beams.back()));
}

/// Whether the segment may be another leg of someone who walks.
bool Tracker::is_leg(const Segment& segment, const Track& track) const {
  return track.extent.box() == nullptr && segment.box_length_m < config_.stride_m && track.extent.largest_span_m < 2.0 * config_.stride_m &&
         (segment.centroid_in_odom_m - track.position_m()).norm() < config_.stride_m;
}

/// Gives those who walk close to one another the segments of their likeliest hypothesis, and forbids these to all others.
void Tracker::assign_competing_tracks(const ScanView& view, association::CostMatrix& costs) {
  const auto may_have = [&](std::size_t track, std::size_t segment) { return !is_of_another_past(segment, track, view); };
  const std::vector<std::size_t> segment_of_track = competing_tracks_.decide(tracks_, view, may_have);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (!competing_tracks_.has(tracks_[t])) continue;
    for (std::size_t s = 0; s < costs.columns; ++s) costs(t, s) = association::kForbidden;
    if (segment_of_track[t] == kUnassigned) continue;
    for (std::size_t other = 0; other < tracks_.size(); ++other) costs(other, segment_of_track[t]) = association::kForbidden;
    shares_.track_of_segment[segment_of_track[t]] = t;
  }
}

void Tracker::give_whole_segments(const ScanView& view) {
  const std::vector<Segment>& segments = view.scan().segments;
  association::CostMatrix& costs = costs_;
  costs.assign(tracks_.size(), segments.size(), association::kForbidden);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (std::size_t s = 0; s < segments.size(); ++s) {
      const double cost = association_cost(tracks_[t].extent.outline, tracks_[t].kinematics.estimate, segments[s], config_);
      if (cost != association::kForbidden && !is_of_another_past(s, t, view)) costs(t, s) = cost;
    }
  if (config_.most_hypotheses > 1) assign_competing_tracks(view, costs);
  const std::vector<std::size_t>& segment_of_track = assigner_.assign(costs, kCostOfMiss);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (segment_of_track[t] != kUnassigned) shares_.track_of_segment[segment_of_track[t]] = t;
  // A body with sides may be seen in pieces: what lies inside it is its own.
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (shares_.track_of_segment[s] != kUnassigned || is_backdrop(segments[s], config_)) continue;
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const Track& track = tracks_[t];
      if (track.extent.box() != nullptr ? !lies_in_body(segments[s], track, view) : !is_leg(segments[s], track)) continue;
      if (is_of_another_past(s, t, view)) continue;
      shares_.track_of_segment[s] = t;
      break;
    }
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const std::size_t t = shares_.track_of_segment[s];
    if (t == kUnassigned) continue;
    add_beams(shares_.beams_of_track[t], segments[s].beams);
    shares_.label_of_track[t] = stronger(shares_.label_of_track[t], segments[s].label);
  }
}

void Tracker::divide_shared_segments(const ScanView& view) {
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    if (!shares_.beams_of_track[t].empty() || !track.existence.confirmed) continue;
    const double margin_m = margin_of(track, config_);
    const ScanView::Directions directions = view.directions_of(track.footprint(), track.position_m(), margin_m);
    std::vector<std::uint16_t>& beams = shares_.beams_of_track[t];
    PointLabel label = PointLabel::kUnknown;
    for (std::size_t i = 0; i < directions.count; ++i) {
      const std::size_t beam = *view.polar().neighbour_of(directions.first, static_cast<long>(i));
      const std::size_t s = view.segment_of_beam(beam);
      if (s == ScanView::kNone) continue;
      const Vector2d& point_m = view.point_in_odom_m(beam);
      if (!is_inside(track.footprint(), track.position_m(), margin_m, point_m)) continue;
      const Segment& segment = view.scan().segments[s];
      const std::size_t owner = shares_.track_of_segment[s];
      if (owner == kUnassigned && is_of_another_past(s, t, view)) continue;
      if (owner != kUnassigned) {
        const double to_owner = (point_m - tracks_[owner].position_m()).norm() / std::max(0.3, tracks_[owner].footprint().width.value_m);
        const double to_track = (point_m - track.position_m()).norm() / std::max(0.3, track.footprint().width.value_m);
        if (to_owner <= to_track) continue;
      }
      beams.push_back(static_cast<std::uint16_t>(beam));
      label = stronger(label, segment.label);
    }
    std::sort(beams.begin(), beams.end());
    for (std::size_t other = 0; other < tracks_.size(); ++other) {
      std::vector<std::uint16_t>& theirs = shares_.beams_of_track[other];
      if (other != t) std::erase_if(theirs, [&](std::uint16_t beam) { return std::binary_search(beams.begin(), beams.end(), beam); });
    }
    shares_.label_of_track[t] = label;
  }
}

void Tracker::associate(const ScanView& view) {
  spare_beams_.resize(shares_.beams_of_track, tracks_.size());
  for (auto& beams : shares_.beams_of_track) beams.clear();
  shares_.label_of_track.assign(tracks_.size(), PointLabel::kUnknown);
  shares_.track_of_segment.assign(view.scan().segments.size(), kUnassigned);
  give_whole_segments(view);
  divide_shared_segments(view);
}

Tracker::PastScans Tracker::past_scans(std::int64_t stamp_ns) const {
  PastScans past;
  past.then = history().older_than(stamp_ns, config_.compare_after_s);
  past.just_now = only_people_move(config_) ? history().older_than(stamp_ns, config_.compare_fast_after_s) : nullptr;
  past.long_ago = history().older_than(stamp_ns, config_.compare_slow_after_s);
  if (only_people_move(config_)) return past;
  constexpr double kSoonS = 0.4;
  constexpr double kLaterS = 0.6;
  for (const double age_s : {config_.compare_fast_after_s, kSoonS, kLaterS, config_.compare_after_s, config_.compare_slow_after_s})
    if (const EarlierScan* then = history().older_than(stamp_ns, age_s); then != nullptr) past.for_faces[past.count_for_faces++] = then;
  return past;
}

void Tracker::compare_with_past(const ScanView& view) {
  const flow::SegmentedScan& scan = view.scan();
  past_of_beam_.assign(scan.range_m.size(), Past::kUnknown);
  past_of_segment_.assign(scan.segments.size(), {});
  has_shifted_.assign(scan.range_m.size(), false);
  const PastScans past = past_scans(scan.stamp_ns);
  constexpr std::size_t kRanges = 4;  // segments are of very different sizes
  work::share_in_ranges(help_, scan.segments.size(), kRanges, [&](std::size_t first, std::size_t end) {
    for (std::size_t s = first; s < end; ++s) compare_with_past(s, past, view);
  });
}

/// Writes of the segment and of its own beams only.
void Tracker::compare_with_past(std::size_t s, const PastScans& past_scans, const ScanView& view) {
  note_face_shift(s, past_scans, view);
  const Segment& segment = view.scan().segments[s];
  SegmentPast past = past_of_segment_[s];
  int arrival = 0;
  int seen = 0;
  int of_vehicles = 0;
  for (const std::uint16_t beam : segment.beams) {
    if (past_scans.then == nullptr) break;
    const SightOfPlace before = past_scans.then->view.sight_of(view.point_in_odom_m(beam));
    if (before.sight == Sight::kThere) {
      ++seen;
      of_vehicles += past_scans.then->owners[before.beam].has_come ? 1 : 0;
    }
    const Past of_beam = has_shifted_[beam] ? Past::kArrived : history().past_of(beam, before, view.polar(), *past_scans.then, only_people_move(config_));
    past_of_beam_[beam] = of_beam;
    past.stood += of_beam == Past::kStood ? 1 : 0;
    past.arrived += of_beam == Past::kArrived ? 1 : 0;
    past.receded += of_beam == Past::kReceded ? 1 : 0;
    const bool is_open = of_beam == Past::kUnknown && past_scans.just_now != nullptr;  // say, by who walked ahead
    const Past since = is_open ? history().past_of(beam, view.polar(), *past_scans.just_now, true) : of_beam;
    past.came += since == Past::kArrived || since == Past::kAppeared ? 1 : 0;
    arrival = of_beam == Past::kArrived ? arrival + 1 : 0;
    past.longest_arrival = std::max(past.longest_arrival, arrival);
  }
  const auto count = static_cast<double>(segment.beams.size());
  if (segment.label != PointLabel::kMoving && may_have_a_flank(segment, config_) && past_scans.long_ago != nullptr)
    past.longest_arrival = std::max(past.longest_arrival, longest_arrival_since(*past_scans.long_ago, segment, view.polar()));
  const bool is_mapped = segment.label == PointLabel::kStationary && segment.moving_share < kMostMovingShare;
  past.stood_before = past.stood > kLeastStoodShare * count;
  past.stands = past.stood_before || (is_mapped && past.stood > kLeastStoodIfMapped * count && past.arrived + past.receded < kLeastChangedShare * count);
  past.has_come = may_have_come(segment, config_) && of_vehicles > kLeastComeShareOfSeen * seen && of_vehicles > kLeastComeShare * count;
  past_of_segment_[s] = past;
}

/// Notes a front or rear that has come from elsewhere.
void Tracker::note_face_shift(std::size_t s, const PastScans& past_scans, const ScanView& view) {
  if (only_people_move(config_)) return;
  const Segment& segment = view.scan().segments[s];
  if (segment.label == PointLabel::kNoEcho || segment.box_length_m > config_.longest_body_m) return;
  const std::span<const EarlierScan* const> earlier(past_scans.for_faces.data(), past_scans.count_for_faces);
  const auto pose_sigma_m = [&] { return std::sqrt(pose_covariance_at(segment.centroid_in_odom_m, view.scan()).trace()); };
  std::optional<FaceShift> shift = face_shift(segment.beams, view.polar(), earlier, pose_sigma_m, config_);
  constexpr double kLongestPieceM = 1.2;
  constexpr std::size_t kSegmentsAside = 2;  // what hides the middle is one itself
  const std::vector<Segment>& segments = view.scan().segments;
  const auto may_be_piece = [&](const Segment& one) { return one.label != PointLabel::kNoEcho && one.box_length_m < kLongestPieceM * config_.size_scale; };
  const std::size_t end = may_be_piece(segment) ? std::min(segments.size(), s + kSegmentsAside + 1) : 0;
  for (std::size_t other = s - std::min(s, kSegmentsAside); !shift && other < end; ++other)
    if (other != s && may_be_piece(segments[other])) shift = face_shift_with(segments[other].beams, segment.beams, view.polar(), earlier, pose_sigma_m, config_);
  if (!shift) return;
  past_of_segment_[s].face_shift_m = shift->shift_m;
  for (const std::uint16_t beam : shift->beams) has_shifted_[beam] = true;
}

/// Whether the echo lies on a side that points along the track's motion: there an object that moves looks as if it stood.
bool Tracker::slides_along_itself(std::uint16_t beam, const Track& track, const ScanView& view) const {
  constexpr double kSlowMps = 3.0;  // a faster one leaves the places where its flank was
  if (track.extent.box() == nullptr || track.velocity_mps().norm() > kSlowMps) return false;
  const std::size_t segment = view.segment_of_beam(beam);
  const auto is_beside = [&](int neighbour) {
    return neighbour >= 0 && neighbour < static_cast<int>(view.polar().beam_count()) && view.segment_of_beam(static_cast<std::size_t>(neighbour)) == segment;
  };
  constexpr int kBeamsAside = 2;
  int low = beam;
  int high = beam;
  for (int i = 1; i <= kBeamsAside; ++i) {
    if (is_beside(beam - i)) low = beam - i;
    if (is_beside(beam + i)) high = beam + i;
  }
  const Vector2d side = view.point_in_odom_m(static_cast<std::size_t>(high)) - view.point_in_odom_m(static_cast<std::size_t>(low));
  const Vector2d along{std::cos(track.footprint().heading_rad), std::sin(track.footprint().heading_rad)};
  constexpr double kCosine = 0.9;
  return std::abs(side.dot(along)) > kCosine * side.norm() && side.squaredNorm() > 0.0;
}

/// What contradicts the map, unless it stood there before; and what comes or goes where the map cannot say, or has not yet
/// unlearnt what stood there.
bool Tracker::may_begin(const Segment& segment, std::size_t index) const {
  const SegmentPast& past = past_of_segment_[index];
  const auto count = static_cast<int>(segment.beams.size());
  if (count < config_.least_points_at_birth) return false;
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (tracks_[t].existence.confirmed && is_vehicle(tracks_[t]) && !shares_.beams_of_track[t].empty() &&
        is_inside(tracks_[t].footprint(), tracks_[t].position_m(), config_.gate_margin_m, segment.centroid_in_odom_m))
      return false;
  if (!past.face_shift_m.isZero()) return true;
  if (segment.label == PointLabel::kMoving) return !past.stood_before;
  constexpr int kFewest = 4;
  constexpr double kLeastFaceShare = 0.15;
  constexpr double kLeastFlankShare = 0.3;
  const bool has_flank = may_have_a_flank(segment, config_) && past.stood > kLeastFlankShare * count;
  if (has_flank && past.longest_arrival >= kFewest && past.longest_arrival >= kLeastFaceShare * count) return true;
  // A leg sends few echoes.
  if (only_people_move(config_) && segment.box_length_m < config_.stride_m && past.came == count) return true;
  const int moved = past.arrived + past.receded;
  return moved >= kFewest && moved > 0.6 * count && segment.box_length_m < config_.longest_body_m;
}

void Tracker::begin_tracks(const ScanView& view) {
  for (std::size_t s = 0; s < view.scan().segments.size(); ++s) {
    const Segment& segment = view.scan().segments[s];
    if (shares_.track_of_segment[s] != kUnassigned || !may_begin(segment, s)) continue;
    const ResponseRate responses = with_responses({}, segment.beams.size(), gaps_between(segment.beams, view.polar()), 0.0);
    const double time_offset_s = view.polar().delay_towards_s(segment.centroid_in_odom_m);
    const Observation observation = observation_of(segment.beams, {time_offset_s, Vector2d::Zero()}, responses, view, config_.size_scale, points_m_);
    const Matrix2d pose_covariance_m2 = pose_covariance_at(segment.centroid_in_odom_m, view.scan());
    // Detection fits boxes to what moves only.
    const double heading_rad = segment.label == PointLabel::kMoving ? segment.box_heading_rad : sensing::fit_box(points_m_, config_.range_noise_m).heading_rad;
    tracks_.push_back(spare_tracks_.take());
    initiate(tracks_.back(), {{next_id_++}, view.scan().stamp_ns, observation, heading_rad, pose_covariance_m2}, config_, *road_users_);
    tracks_.back().history.birth.centre_m -= past_of_segment_[s].face_shift_m;  // where it was when it was first seen
    tracks_.back().kinematics.time_offset_s = time_offset_s;
    tracks_.back().history.scanner = scanner_;
    tracks_.back().history.observations.add(view.scan().stamp_ns + nanoseconds(time_offset_s), observation, pose_covariance_m2);
    tracks_.back().extent.responses = responses;
    tracks_.back().existence.mean_echoes = static_cast<double>(segment.beams.size());
      shares_.track_of_segment[s] = tracks_.size() - 1;
    spare_beams_.resize(shares_.beams_of_track, tracks_.size());
    shares_.beams_of_track.back() = segment.beams;
    shares_.label_of_track.push_back(segment.label);
    ++counters_.tracks_begun;
  }
}

/// Places that the track's echoes came from and that were seen through then, and places that its echoes came from then and
/// that are seen through now, say that it has moved.
MotionEvidence Tracker::evidence_against(const EarlierScan& then, std::size_t track, const ScanView& view) const {
  MotionEvidence evidence;
  const bool is_known = &then == history().older_than(view.scan().stamp_ns, config_.compare_after_s);
  for (const std::uint16_t beam : shares_.beams_of_track[track]) {
    // A wall that answers bit by bit appears, too.
    const bool may_appear = only_people_move(config_) && view.scan().segments[view.segment_of_beam(beam)].box_length_m < config_.stride_m;
    const bool is_compared = has_shifted_[beam] || (is_known && !only_people_move(config_));
    const Past past = is_compared ? past_of_beam_[beam] : history().past_of(beam, view.polar(), then, may_appear);
    const bool has_stayed = past_of_beam_[beam] == Past::kStood;  // since it came into sight
    if (past == Past::kArrived || (past == Past::kAppeared && !has_stayed)) evidence.moved += 1.0;
    else if (past == Past::kStood || past == Past::kAppeared) evidence.stood += slides_along_itself(beam, tracks_[track], view) ? kStoodIfSliding : 1.0;
    else evidence.undecided += 1.0;
  }
  if (then.stamp_ns < tracks_[track].history.first_seen_ns) return evidence;  // it had none then
  for (std::size_t beam = 0; beam < then.owners.size(); ++beam) {
    if (!then.owners[beam].is_owned || then.owners[beam].track_id != tracks_[track].track_id) continue;
    if (view.polar().sight_of(then.view.point_in_odom_m(beam)).sight == Sight::kThrough) evidence.moved += 1.0;
  }
  return evidence;
}

MotionEvidence Tracker::evidence_of(std::size_t track, const ScanView& view) const {
  MotionEvidence best;
  double best_share = -1.0;
  const std::int64_t stamp_ns = view.scan().stamp_ns;
  if (tracks_[track].existence.confirmed) {
    for (const std::uint16_t beam : shares_.beams_of_track[track]) {
      if (past_of_beam_[beam] == Past::kStood) best.stood += slides_along_itself(beam, tracks_[track], view) ? kStoodIfSliding : 1.0;
      best.moved += past_of_beam_[beam] == Past::kArrived || past_of_beam_[beam] == Past::kAppeared ? 1.0 : 0.0;
      best.undecided += past_of_beam_[beam] == Past::kUnknown ? 1.0 : 0.0;
    }
    return best;
  }
  for (const double age_s : {config_.compare_fast_after_s, config_.compare_after_s, config_.compare_slow_after_s}) {
    const EarlierScan* then = history().older_than(stamp_ns, age_s);
    if (then == nullptr) continue;
    const MotionEvidence evidence = evidence_against(*then, track, view);
    const double share = evidence.moved / std::max(1.0, evidence.moved + evidence.stood);
    if (share > best_share) best_share = share, best = evidence;
  }
  return best;
}

/// Holds the velocity of a track that is young, or known again, against what earlier scans saw: ends that come into view, echoes that
/// another track takes, or those of another vehicle that comes by where this was hidden, make a body seem to fly.
void Tracker::check_velocity(std::size_t index, const Observation& observation, const ScanView& view) {
  constexpr double kYoungS = 2.0;
  constexpr double kLongEnoughS = 0.35;     // for what earlier scans did not see well
  constexpr double kSlowMps = 4.0;
  constexpr double kSlackMps = 1.0;
  constexpr double kTellingSigmaMps = 2.0;
  constexpr double kVagueSigmaMps = 4.0;
  Track& track = tracks_[index];
  track.existence.velocity_check.is_refuted = false;
  const double age_s = static_cast<double>(view.scan().stamp_ns - track.history.first_seen_ns) * kNanosecond_s;
  const double known_s = static_cast<double>(view.scan().stamp_ns - std::max(track.history.first_seen_ns, track.existence.velocity_check.known_since_ns)) * kNanosecond_s;
  const Vector2d velocity_mps = track.velocity_mps();
  const bool is_fast = velocity_mps.norm() > kSlowMps;
  if (known_s > kYoungS || (track.extent.box() == nullptr && !is_fast)) return;
  const Vector2d along = track.extent.box() != nullptr ? Vector2d(std::cos(track.footprint().heading_rad), std::sin(track.footprint().heading_rad)) : Vector2d(velocity_mps.normalized());
  const double speed_mps = velocity_mps.dot(along);
  const double across_mps = (velocity_mps - speed_mps * along).norm();
  const SpeedEvidence evidence = speed_along(along, observation.points_m, view.scan().stamp_ns, history(), kFastestOfSigmas * config_.fastest_mps, track.track_id);
  const bool flies_sideways = across_mps > 2.0 + 0.3 * std::abs(speed_mps);
  const bool is_off = flies_sideways || std::abs(speed_mps - evidence.speed_mps) > 3.0 * evidence.sigma_mps + kSlackMps;
  const bool is_vague = is_fast && age_s < kLongEnoughS && evidence.sigma_mps > kVagueSigmaMps && !appeared_in_free_space(track, config_);
  if (is_off && evidence.sigma_mps < kTellingSigmaMps) restart_velocity(track.kinematics, evidence.speed_mps * along, evidence.sigma_mps, config_);
  else track.existence.velocity_check.is_refuted = is_off || is_vague;
}

void Tracker::remember(const ScanView& view) {
  if (!history().is_due(view.scan().stamp_ns)) return;
  owners_.assign(view.scan().range_m.size(), {});
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (const std::uint16_t beam : shares_.beams_of_track[t]) owners_[beam] = {tracks_[t].track_id, true, tracks_[t].existence.confirmed, tracks_[t].existence.confirmed && tracks_[t].extent.box() != nullptr};
  for (std::size_t s = 0; s < past_of_segment_.size(); ++s) {
    if (!past_of_segment_[s].has_come) continue;
    for (const std::uint16_t beam : view.scan().segments[s].beams) owners_[beam].has_come = true;
  }
  scanners_[scanner_].history.add(view.scan().stamp_ns, view.polar(), owners_);
}

/// The echoes are of something else, which may become a track of its own.
void Tracker::release(std::size_t index) {
  tracks_[index].existence.score += config_.surprise_score;
  shares_.beams_of_track[index].clear();
  std::replace(shares_.track_of_segment.begin(), shares_.track_of_segment.end(), index, kUnassigned);
}

/// Who has long been known to walk does not become large at once: the rest is a wall, or someone beside.
void Tracker::leave_out_surroundings(std::size_t index, double time_s, const ScanView& view) {
  constexpr int kLongKnownHits = 20;
  constexpr double kBelievedAfterS = 0.5;
  Track& track = tracks_[index];
  std::vector<std::uint16_t>& beams = shares_.beams_of_track[index];
  const bool is_sure = is_known_pedestrian(track);
  const bool may_be_pedestrian = is_sure || (track.existence.confirmed && track.extent.box() == nullptr && track.existence.hits >= kLongKnownHits && track.velocity_mps().norm() < kFastestWalkMps);
  if (!may_be_pedestrian || beams.empty()) return;
  const auto is_near = [&](std::uint16_t beam) { return (view.point_in_odom_m(beam) - track.position_m()).norm() < config_.stride_m + (is_sure ? 0.0 : config_.gate_margin_m); };
  const Ends ends = ends_of(beams, view.polar());
  const bool has_outgrown = (view.point_in_odom_m(ends.last) - view.point_in_odom_m(ends.first)).norm() > config_.box_from_extent_m;
  track.extent.misfit.oversized_s = has_outgrown ? track.extent.misfit.oversized_s + time_s : 0.0;
  if (!has_outgrown || (!is_sure && track.extent.misfit.oversized_s > kBelievedAfterS) || std::ranges::none_of(beams, is_near)) return;
  std::erase_if(beams, [&](std::uint16_t beam) { return !is_near(beam); });
}

/// With those of this scan.
TentativeEvidence Tracker::with_echoes(TentativeEvidence observations, const std::vector<std::uint16_t>& beams, const ScanView& view) const {
  for (const std::uint16_t beam : beams) {
    observations.seen += 1.0;
    observations.in_free_space += view.scan().labels[beam] == PointLabel::kMoving ? 1.0 : 0.0;
    observations.stood += past_of_beam_[beam] == Past::kStood ? 1.0 : 0.0;
  }
  return observations;
}

/// Takes the echoes of each track; what concerns others than it is done afterwards, in the order of the tracks.
void Tracker::correct_all(const ScanView& view) {
  if (observed_points_m_.size() < tracks_.size()) observed_points_m_.resize(tracks_.size());
  outcomes_.resize(tracks_.size());
  work::share(help_, tracks_.size(), [&](std::size_t t) { outcomes_[t] = correct(t, view); });
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    if (outcomes_[t] == Outcome::kIsOfSomethingElse) release(t);
    if (outcomes_[t] == Outcome::kIsConfirmed) confirm(t);
  }
}

/// Whether the echoes are the track's own, by which it is corrected then. Once they may be somebody else's; again and again,
/// in its place, they tell that it is drawn wrong.
bool Tracker::takes(std::size_t index, const Observation& observation, double time_s, const flow::SegmentedScan& scan) {
  constexpr double kKnownToMoveM = 5.0;
  constexpr double kDrawnWrongAfterS = 0.1;
  constexpr std::size_t kFewestEchoes = 6;  // around fewer it would be drawn no better
  Track& track = tracks_[index];
  const Matrix2d pose_covariance_m2 = pose_covariance_at(track.position_m(), scan);
  if (!update(track, scan.stamp_ns, observation, pose_covariance_m2, config_)) {
    track.extent.misfit.rejected_s += time_s;
    const bool surely_moves = shares_.label_of_track[index] == PointLabel::kMoving && track.existence.travel.travelled_m > kKnownToMoveM * config_.size_scale;
    const bool may_be_drawn = track.extent.box() != nullptr && observation.points_m.size() >= kFewestEchoes;
    if (!may_be_drawn || !surely_moves || track.extent.misfit.rejected_s < kDrawnWrongAfterS) return false;
    reinitialise_extent(track, observation, config_);
    if (!update(track, scan.stamp_ns, observation, pose_covariance_m2, config_)) return false;
  }
  track.extent.misfit.rejected_s = 0.0;
  return true;
}

/// A scan that cannot see the place says nothing of a track that another scanner has in its field of view. Once that one
/// has lost it from view, too, its own scans say so.
bool Tracker::is_left_to_another_scanner(const Track& track, const Visibility& visibility) const {
  return visibility.beams == 0 && track.history.scanner != scanner_;
}

/// Writes of the track only.
Tracker::Outcome Tracker::correct(std::size_t index, const ScanView& view) {
  Track& track = tracks_[index];
  const std::vector<std::uint16_t>& beams = shares_.beams_of_track[index];
  if (scanners_.size() > 1) {
    const Visibility visibility = view.visibility_of(track.footprint(), track.position_m());
    if (beams.empty() && is_left_to_another_scanner(track, visibility)) return Outcome::kGoesOn;
    if (!beams.empty() || visibility.beams > 0) track.history.scanner = scanner_;
  }
  const double time_s = std::exchange(track.history.since_in_view_s, 0.0);
  leave_out_surroundings(index, time_s, view);
  constexpr double kEchoMemoryS = 0.2;
  track.existence.mean_echoes += (1.0 - std::exp(-time_s / kEchoMemoryS)) * (static_cast<double>(beams.size()) - track.existence.mean_echoes);
  if (beams.empty()) {
    score_miss(track, view.visibility_of(track.footprint(), track.position_m()), time_s, config_);
    return Outcome::kGoesOn;
  }
  track.extent.responses = with_responses(track.extent.responses, beams.size(), gaps_between(beams, view.polar()), time_s);
  const Observation observation = observation_of(beams, swept_motion(track), track.extent.responses, view, config_.size_scale, observed_points_m_[index]);
  const bool was_known = has_published_velocity(track, config_);
  if (!takes(index, observation, time_s, view.scan())) return Outcome::kIsOfSomethingElse;
  const bool is_known_again = track.existence.confirmed && !was_known && has_published_velocity(track, config_);
  if (is_known_again) track.existence.velocity_check.known_since_ns = view.scan().stamp_ns;
  if (!track.existence.confirmed) track.existence.tentative = with_echoes(track.existence.tentative, beams, view);
  score_hit(track, {shares_.label_of_track[index], evidence_of(index, view), time_s}, config_);
  if (track.existence.confirmed && is_vehicle(track)) {
    const Visibility inside = view.visibility_of(interior_of(track), track.position_m());
    score_passed(track, inside, beams.size(), config_);
    track.existence.passage = with_beams(track.existence.passage, inside.passed, beams.size(), time_s);
  }
  if (!track.existence.confirmed) track.history.observations.add(view.scan().stamp_ns + nanoseconds(track.kinematics.time_offset_s), observation, pose_covariance_at(track.position_m(), view.scan()));
  if (!track.existence.confirmed) reinitialise_extent_if_misfit(track, observation, time_s, config_);
  if (!track.existence.confirmed && is_confirmable(track, config_)) {
    const Belief before = belief_of(track);
    set_belief(track, refiltered(track, config_));
    const bool was_turned = std::abs(std::sin(footprint_of(before.outline).heading_rad - track.footprint().heading_rad)) > 0.7;
    const bool is_surely_turned = was_turned && track.extent.box()->is_oriented;
    if (!is_surely_turned && !is_confirmable(track, config_)) set_belief(track, before);  // what it lacks is but certainty
  }
  const bool may_be_confirmed = !track.existence.confirmed && is_confirmable(track, config_);
  constexpr int kHitsBetweenChecks = 5;
  if (may_be_confirmed || is_known_again || (track.existence.confirmed && track.existence.hits % kHitsBetweenChecks == 0)) check_velocity(index, observation, view);
  return may_be_confirmed && !track.existence.velocity_check.is_refuted && is_confirmable(track, config_) ? Outcome::kIsConfirmed : Outcome::kGoesOn;
}

void Tracker::confirm(std::size_t index) {
  Track& track = tracks_[index];
  tracking::confirm(track, last_stamp_ns_, config_);
  // On a road a false track would so excuse whatever stood in its place.
  if (only_people_move(config_)) {
    for (OfScanner& scanner : scanners_) scanner.history.confirm(track.track_id);
  }
  ++counters_.tracks_confirmed;
}

/// Gives a all that b has; b is marked for removal.
void Tracker::absorb(std::size_t a, std::size_t b) {
  tracks_[b].existence.hits = 0;
  add_beams(shares_.beams_of_track[a], shares_.beams_of_track[b]);
  shares_.beams_of_track[b].clear();
  ++counters_.tracks_merged;
}

/// Two ends of one vehicle, the middle of which is hidden or dark, are seen as two.
void Tracker::join_pieces(const ScanView& view) {
  for (std::size_t a = 0; a < tracks_.size(); ++a) {
    if (!is_long_known(tracks_[a]) || shares_.beams_of_track[a].empty()) continue;
    for (std::size_t b = 0; b < tracks_.size(); ++b) {
      if (a == b || tracks_[a].existence.hits < tracks_[b].existence.hits || !is_long_known(tracks_[b]) || shares_.beams_of_track[b].empty()) continue;
      if (!are_parts_of_one_vehicle(tracks_[a], tracks_[b], config_) || is_seen_between(shares_.beams_of_track[a], shares_.beams_of_track[b], view.polar())) continue;
      absorb(a, b);
      reinitialise_extent(tracks_[a], observation_of(shares_.beams_of_track[a], swept_motion(tracks_[a]), tracks_[a].extent.responses, view, config_.size_scale, points_m_), config_);
    }
  }
}

void Tracker::merge_duplicates() {
  for (std::size_t a = 0; a < tracks_.size(); ++a) {
    for (std::size_t b = 0; b < tracks_.size(); ++b) {
      if (a == b || tracks_[b].existence.hits == 0 || tracks_[a].existence.hits == 0) continue;
      if (is_duplicate(tracks_[b], tracks_[a], config_)) absorb(a, b);
    }
  }
}

/// What was kept out of the map for the track's sake is told to whose scans it was of.
void Tracker::restore(const Track& track, flow::ScanLabels& labels) {
  for (const PastPoints& past : track.history.past_points.all()) {
    std::vector<flow::RestoredPoints>& restored = past.scanner == scanner_ ? labels.restored : scanners_[past.scanner].restored;
    const auto same = std::ranges::find_if(restored, [&](const auto& one) { return one.sequence == past.points.sequence; });
    counters_.points_restored += past.points.beams.size();
    if (same != restored.end()) {
      add_beams(same->beams, past.points.beams);
    } else {
      spare_restored_.resize(restored, restored.size() + 1);
      restored.back() = past.points;
    }
  }
}

void Tracker::remove_dead(flow::ScanLabels& labels) {
  const auto is_over = [&](const Track& track) {
    if (track.existence.hits == 0) return true;
    const bool is_dead = has_ended(track, last_stamp_ns_, config_);
    if (is_dead && !track.existence.confirmed) {
      ++counters_.tracks_rejected;
      restore(track, labels);
    }
    if (is_dead) learn_from(road_users_seen_, track, config_);
    return is_dead;
  };
  std::size_t kept = 0;
  for (Track& track : tracks_) {
    if (is_over(track)) {
      spare_tracks_.give(std::move(track));
      continue;
    }
    if (&track != &tracks_[kept]) tracks_[kept] = std::move(track);
    ++kept;
  }
  tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(kept), tracks_.end());
  constexpr std::size_t kMostRestored = 64;
  if (labels.restored.size() > kMostRestored) spare_restored_.resize(labels.restored, kMostRestored);
  for (OfScanner& scanner : scanners_) {
    if (scanner.restored.size() > kMostRestored) spare_restored_.resize(scanner.restored, kMostRestored);
  }
}

bool Tracker::is_late(const flow::SegmentedScan& scan) const {
  if (!has_scan_ || scan.stamp_ns > last_stamp_ns_) return false;
  if (scan.stamp_ns < last_stamp_ns_ || scanners_at_last_.empty()) return true;
  return std::ranges::any_of(scanners_at_last_, [&](std::size_t scanner) { return scanners_[scanner].scanner_id == scan.scanner_id; });
}

void Tracker::begin_scan(const flow::SegmentedScan& scan) {
  const auto known = std::ranges::find(scanners_, scan.scanner_id, &OfScanner::scanner_id);
  scanner_ = static_cast<std::size_t>(known - scanners_.begin());
  if (known == scanners_.end()) scanners_.push_back({scan.scanner_id, {}, {}});
  if (!has_scan_ || scan.stamp_ns != last_stamp_ns_) scanners_at_last_.clear();
  scanners_at_last_.push_back(scanner_);
  has_scan_ = true;
  last_stamp_ns_ = scan.stamp_ns;
}

TrackingResult Tracker::track(const flow::SegmentedScan& scan, TrackingResult done_with) {
  TrackingResult result = std::move(done_with);
  result.labels.stamp_ns = scan.stamp_ns;
  result.labels.sequence = scan.sequence;
  result.labels.scanner_id = scan.scanner_id;
  result.labels.labels = scan.labels;
  spare_restored_.resize(result.labels.restored, 0);
  if (is_late(scan)) {
    ++counters_.late_scans;
    describe(scan, result.objects);
    return result;
  }
  const double time_s = has_scan_ ? static_cast<double>(scan.stamp_ns - last_stamp_ns_) * kNanosecond_s : 0.0;
  begin_scan(scan);
  result.labels.restored.swap(scanners_[scanner_].restored);
  ++counters_.scans;
  view_.look_at(scan);
  const ScanView& view = view_;
  for (Track& track : tracks_) predict_to_its_beam(track, time_s, view.polar(), config_);
  competing_tracks_.predict(time_s);
  compare_with_past(view);
  associate(view);
  correct_all(view);
  if (config_.formations) formations_.follow(tracks_, time_s);
  begin_tracks(view);
  join_pieces(view);
  merge_duplicates();
  remember(view);
  label(view, result.labels);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    if (track.existence.confirmed || shares_.beams_of_track[t].empty()) continue;
    if (track.history.past_points.size() == kMostPastScans) track.history.past_points.pop_front();
    PastPoints& past = track.history.past_points.push_back();
    past.scanner = scanner_;
    past.points.sequence = scan.sequence;
    past.points.beams = shares_.beams_of_track[t];
    // What is known to have come is not given back to the map with a track that has proven nothing.
    std::erase_if(past.points.beams, [&](std::uint16_t beam) { return past_of_segment_[view.segment_of_beam(beam)].has_come; });
  }
  const std::size_t followed = tracks_.size();
  remove_dead(result.labels);
  describe(scan, result.objects);
  if (tracks_.size() < followed) *road_users_ = road_users_seen_.known();
  return result;
}

/// In labels that are those of detection until now.
void Tracker::label(const ScanView& view, flow::ScanLabels& labels) {
  const flow::SegmentedScan& scan = view.scan();
  for (std::size_t s = 0; s < scan.segments.size(); ++s) {
    const Segment& segment = scan.segments[s];
    for (const std::uint16_t beam : segment.beams) {
      // A lone contradiction in something that stands is the map's error: let it learn.
      if (segment.label == PointLabel::kStationary && labels.labels[beam] == PointLabel::kMoving) labels.labels[beam] = PointLabel::kStationary;
      if (past_of_segment_[s].has_come) labels.labels[beam] = PointLabel::kMoving;
      else if (segment.label == PointLabel::kMoving) labels.labels[beam] = past_of_segment_[s].stood_before ? PointLabel::kStationary : PointLabel::kMoving;
    }
  }
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (tracks_[t].existence.confirmed)
      for (const std::uint16_t beam : shares_.beams_of_track[t]) labels.labels[beam] = PointLabel::kMoving;
}

void Tracker::describe(const flow::SegmentedScan& scan, flow::TrackedObjects& objects) {
  objects.stamp_ns = scan.stamp_ns;
  objects.sequence = scan.sequence;
  objects.map_from_odom = scan.map_from_odom;
  objects.odom_from_base = scan.odom_from_base.pose;
  objects.map_id = scan.map_id;
  objects.odom_id = scan.odom_id;
  spare_objects_.resize(objects.objects, tracks_.size());
  work::share(help_, tracks_.size(), [&](std::size_t t) { publish(tracks_[t], scan.stamp_ns, config_, objects.objects[t]); });
}

void Tracker::resume(const flow::TrackedObjects& objects) {
  tracks_.clear();
  road_users_seen_ = {};
  competing_tracks_ = CompetingTracks(config_);
  formations_ = Formations(config_);
  scanners_.clear();
  scanners_at_last_.clear();
  for (const flow::TrackedObject& object : objects.objects) {
    next_id_ = std::max(next_id_, object.track_id.value + 1);
    if (object.confirmed) tracks_.push_back(track_from_message(object, config_));
  }
  *road_users_ = road_users_seen_.known();
  for (Track& track : tracks_) track.extent.footprint().road_users = road_users_.get();
  last_stamp_ns_ = objects.stamp_ns;
  has_scan_ = true;
}

}  // namespace slammot::tracking
