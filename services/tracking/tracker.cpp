#include "services/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "common/association/assignment.hpp"
#include "common/association/gating.hpp"

namespace slammot::tracking {
namespace {

using association::kUnassigned;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;

constexpr double kNanosecond_s = 1e-9;
constexpr std::size_t kMostPastScans = 64;

/// Pose uncertainty as it moves a point at this place; Wang 2004, Eq. (2.3).
Matrix2d pose_covariance_at(const Vector2d& point_in_odom_m, const flow::SegmentedScan& scan) {
  const Vector2d point_in_base_m = geometry::inverse(scan.odom_from_base.pose) * point_in_odom_m;
  const geometry::Matrix3 J =
      geometry::compound_jacobian_first(scan.odom_from_base.pose, {point_in_base_m.x(), point_in_base_m.y(), 0.0});
  return (J * scan.odom_from_base.covariance * J.transpose()).topLeftCorner<2, 2>();
}

/// A segment that could not be a whole object of its own, but of which a part may be one.
bool is_backdrop(const Segment& segment, const TrackingConfig& config) {
  return segment.label == PointLabel::kNoEcho ||
         (segment.label != PointLabel::kMoving && segment.box_length_m > config.longest_body_m);
}

/// Cost of holding the segment for (a part of) the track's body; kForbidden outside the gate. Wang 2004, Eq. (5.10)
/// without its constant: squared distance plus the logarithm of the spread, and what speaks against the pair.
double pair_cost(const Track& track, const Segment& segment, const TrackingConfig& config) {
  if (is_backdrop(segment, config)) return association::kForbidden;
  const Vector2d to_middle_m = segment.centroid_in_odom_m - track.position_m();
  const double reach_m = config.widest_gate_m + 0.5 * std::hypot(track.body.length.value_m, track.body.width.value_m);
  if (to_middle_m.squaredNorm() > reach_m * reach_m) return association::kForbidden;
  const Vector2d residual_m = offset_from_box(track.body, track.position_m(), 0.0, segment.centroid_in_odom_m);
  Matrix2d S = track.position_covariance_m2() + segment.centroid_covariance_m2;
  const double shape_m = config.shape_noise_m + config.blob_noise_share * segment.box_length_m;
  S.diagonal().array() += shape_m * shape_m;
  const double distance2 = association::mahalanobis_squared<2>(residual_m, S);
  if (distance2 > association::planar_gate(config.gate_share)) return association::kForbidden;
  const double body_m = std::max(0.5, track.body.length.value_m);
  const double outgrown_m = std::max(0.0, segment.box_length_m - track.body.length.value_m - config.gate_margin_m);
  const double larger_cost = track.body.has_sides ? config.larger_body_cost_per_m * outgrown_m : 0.3 * outgrown_m;
  return distance2 + 0.5 * to_middle_m.squaredNorm() / (body_m * body_m) + std::log(std::sqrt(S.determinant()) / 0.01) +
         larger_cost + (segment.label == PointLabel::kMoving ? 0.0 : config.other_label_cost);
}

PointLabel stronger(PointLabel a, PointLabel b) {
  for (const PointLabel label : {PointLabel::kMoving, PointLabel::kStationary})
    if (a == label || b == label) return label;
  return PointLabel::kUnknown;
}

bool is_slow(const Track& track) { return track.velocity_mps().norm() < 1.5; }

/// How far into the body's neighbourhood a point may lie and still be the body's.
double margin_of(const Track& track, const TrackingConfig& config) {
  const double sigma_m = std::sqrt(0.5 * track.position_covariance_m2().trace());
  return config.gate_margin_m + std::min(1.0, sigma_m);
}

void add_beams(std::vector<std::uint16_t>& beams, const std::vector<std::uint16_t>& more) {
  beams.insert(beams.end(), more.begin(), more.end());
  std::sort(beams.begin(), beams.end());
}

/// The points of some beams, with what hides their ends.
Glimpse glimpse_of(const std::vector<std::uint16_t>& beams, const ScanView& view, std::vector<Vector2d>& points_m) {
  points_m.clear();
  for (const std::uint16_t beam : beams) points_m.push_back(view.point_in_odom_m(beam));
  const Segment& first = view.scan().segments[view.segment_of_beam(beams.front())];
  const Segment& last = view.scan().segments[view.segment_of_beam(beams.back())];
  return {points_m, view.laser_in_odom_m(), view.beam_step_rad(), first.occluded_at_start, last.occluded_at_end};
}

bool bodies_coincide(const Track& a, const Track& b, const TrackingConfig& config) {
  if ((a.velocity_mps() - b.velocity_mps()).norm() > 1.5 + 0.2 * a.velocity_mps().norm()) return false;
  const bool b_in_a = offset_from_box(a.body, a.position_m(), -config.merge_overlap_m, b.position_m()).isZero();
  const bool a_in_b = offset_from_box(b.body, b.position_m(), -config.merge_overlap_m, a.position_m()).isZero();
  if (a.body.has_sides || b.body.has_sides) return b_in_a || a_in_b;
  return (a.position_m() - b.position_m()).norm() < config.merge_overlap_m;
}

bool is_worth_more(const Track& a, const Track& b) {
  if (a.confirmed != b.confirmed) return a.confirmed;
  return a.track_id < b.track_id;
}

}  // namespace

Tracker::Tracker(const TrackingConfig& config) : config_(config) {}

void Tracker::give_whole_segments(const ScanView& view) {
  const std::vector<Segment>& segments = view.scan().segments;
  association::CostMatrix costs(tracks_.size(), segments.size(), association::kForbidden);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    for (std::size_t s = 0; s < segments.size(); ++s) costs(t, s) = pair_cost(tracks_[t], segments[s], config_);
  const double cost_of_leaving_out = 25.0;
  const std::vector<std::size_t> segment_of_track = association::assign(costs, cost_of_leaving_out);
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (segment_of_track[t] != kUnassigned) shares_.track_of_segment[segment_of_track[t]] = t;
  // A body with sides may be seen in pieces: what lies inside it is its own.
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (shares_.track_of_segment[s] != kUnassigned || is_backdrop(segments[s], config_)) continue;
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const Track& track = tracks_[t];
      if (!track.body.has_sides || (segments[s].label != PointLabel::kMoving && !is_slow(track))) continue;
      if (segments[s].box_length_m > track.body.length.value_m + config_.gate_margin_m) continue;
      if (!offset_from_box(track.body, track.position_m(), margin_of(track, config_), segments[s].centroid_in_odom_m).isZero()) continue;
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
    if (!shares_.beams_of_track[t].empty() || !track.confirmed) continue;
    const double margin_m = margin_of(track, config_);
    const ScanView::Directions directions = view.directions_of(track.body, track.position_m(), margin_m);
    std::vector<std::uint16_t> beams;
    PointLabel label = PointLabel::kUnknown;
    for (std::size_t beam = directions.first; beam < directions.last; ++beam) {
      const std::size_t s = view.segment_of_beam(beam);
      if (s == ScanView::kNone) continue;
      const Vector2d& point_m = view.point_in_odom_m(beam);
      if (!offset_from_box(track.body, track.position_m(), margin_m, point_m).isZero()) continue;
      const Segment& segment = view.scan().segments[s];
      const std::size_t owner = shares_.track_of_segment[s];
      if (owner == kUnassigned && segment.label != PointLabel::kMoving && !is_slow(track)) continue;
      if (owner != kUnassigned) {
        const double to_owner = (point_m - tracks_[owner].position_m()).norm() / std::max(0.3, tracks_[owner].body.width.value_m);
        const double to_track = (point_m - track.position_m()).norm() / std::max(0.3, track.body.width.value_m);
        if (to_owner <= to_track) continue;
      }
      beams.push_back(static_cast<std::uint16_t>(beam));
      label = stronger(label, segment.label);
    }
    for (std::size_t other = 0; other < tracks_.size(); ++other) {
      std::vector<std::uint16_t>& theirs = shares_.beams_of_track[other];
      std::erase_if(theirs, [&](std::uint16_t beam) { return std::binary_search(beams.begin(), beams.end(), beam); });
    }
    shares_.beams_of_track[t] = std::move(beams);
    shares_.label_of_track[t] = label;
  }
}

void Tracker::associate(const ScanView& view) {
  shares_.beams_of_track.resize(tracks_.size());
  for (auto& beams : shares_.beams_of_track) beams.clear();
  shares_.label_of_track.assign(tracks_.size(), PointLabel::kUnknown);
  shares_.track_of_segment.assign(view.scan().segments.size(), kUnassigned);
  give_whole_segments(view);
  divide_shared_segments(view);
}

void Tracker::begin_tracks(const ScanView& view) {
  std::vector<Vector2d> points_m;
  for (std::size_t s = 0; s < view.scan().segments.size(); ++s) {
    const Segment& segment = view.scan().segments[s];
    if (segment.label != PointLabel::kMoving || shares_.track_of_segment[s] != kUnassigned) continue;
    if (static_cast<int>(segment.beams.size()) < config_.least_points_at_birth) continue;
    const Glimpse glimpse = glimpse_of(segment.beams, view, points_m);
    const Matrix2d pose_covariance_m2 = pose_covariance_at(segment.centroid_in_odom_m, view.scan());
    tracks_.push_back(begun({next_id_++}, view.scan().stamp_ns, glimpse, pose_covariance_m2, config_));
    tracks_.back().moving_hits = 1;
    shares_.track_of_segment[s] = tracks_.size() - 1;
    shares_.beams_of_track.push_back(segment.beams);
    shares_.label_of_track.push_back(PointLabel::kMoving);
    ++counters_.tracks_begun;
  }
}

void Tracker::merge_duplicates() {
  for (std::size_t a = 0; a < tracks_.size(); ++a) {
    for (std::size_t b = 0; b < tracks_.size(); ++b) {
      if (a == b || tracks_[b].hits == 0 || tracks_[a].hits == 0 || !is_worth_more(tracks_[a], tracks_[b])) continue;
      if (!bodies_coincide(tracks_[a], tracks_[b], config_)) continue;
      tracks_[b].hits = 0;  // marks it for removal
      add_beams(shares_.beams_of_track[a], shares_.beams_of_track[b]);
      shares_.beams_of_track[b].clear();
      ++counters_.tracks_merged;
    }
  }
}

void Tracker::remove_dead(flow::ScanLabels& labels) {
  const auto restore = [&](const Track& track) {
    for (const flow::RestoredPoints& past : track.past) {
      const auto same = std::find_if(labels.restored.begin(), labels.restored.end(), [&](const auto& one) { return one.sequence == past.sequence; });
      counters_.points_restored += past.beams.size();
      if (same == labels.restored.end()) labels.restored.push_back(past);
      else add_beams(same->beams, past.beams);
    }
  };
  std::erase_if(tracks_, [&](const Track& track) {
    if (track.hits == 0) return true;
    const double unseen_s = static_cast<double>(last_stamp_ns_ - track.last_seen_ns) * kNanosecond_s;
    const double age_s = static_cast<double>(last_stamp_ns_ - track.first_seen_ns) * kNanosecond_s;
    const bool is_lost = unseen_s > (track.confirmed ? config_.longest_unseen_s : config_.longest_unseen_tentative_s);
    const bool has_stood = !track.confirmed && age_s > config_.longest_tentative_s;
    const bool is_dead = is_lost || has_stood || track.score < config_.reject_score;
    if (is_dead && !track.confirmed) {
      ++counters_.tracks_rejected;
      restore(track);
    }
    return is_dead;
  });
  constexpr std::size_t kMostRestored = 64;
  if (labels.restored.size() > kMostRestored) labels.restored.resize(kMostRestored);
}

TrackingResult Tracker::track(const flow::SegmentedScan& scan) {
  TrackingResult result;
  if (has_scan_ && scan.stamp_ns <= last_stamp_ns_) {
    ++counters_.late_scans;
    result.labels = {scan.stamp_ns, scan.sequence, scan.scanner_id, scan.labels, {}};
    result.objects = describe(scan);
    return result;
  }
  const double time_s = has_scan_ ? static_cast<double>(scan.stamp_ns - last_stamp_ns_) * kNanosecond_s : 0.0;
  has_scan_ = true;
  last_stamp_ns_ = scan.stamp_ns;
  ++counters_.scans;
  const ScanView view(scan);
  for (Track& track : tracks_) predict(track, time_s, config_);
  associate(view);
  std::vector<Vector2d> points_m;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    const std::vector<std::uint16_t>& beams = shares_.beams_of_track[t];
    if (beams.empty()) {
      score_miss(track, view.visibility_of(track.body, track.position_m()), time_s, config_);
      continue;
    }
    update(track, scan.stamp_ns, glimpse_of(beams, view, points_m), pose_covariance_at(track.position_m(), scan), config_);
    score_hit(track, shares_.label_of_track[t], config_);
    if (!track.confirmed && has_proven_to_move(track, config_)) {
      track.confirmed = true;
      track.past.clear();
      ++counters_.tracks_confirmed;
    }
  }
  begin_tracks(view);
  merge_duplicates();
  result.labels = label(view);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    if (track.confirmed || shares_.beams_of_track[t].empty()) continue;
    track.past.push_back({scan.sequence, shares_.beams_of_track[t]});
    if (track.past.size() > kMostPastScans) track.past.pop_front();
  }
  remove_dead(result.labels);
  result.objects = describe(scan);
  return result;
}

flow::ScanLabels Tracker::label(const ScanView& view) const {
  const flow::SegmentedScan& scan = view.scan();
  flow::ScanLabels labels{scan.stamp_ns, scan.sequence, scan.scanner_id, scan.labels, {}};
  for (const Segment& segment : scan.segments) {
    for (const std::uint16_t beam : segment.beams) {
      // A lone contradiction in something that stands is the map's error: let it learn.
      if (segment.label == PointLabel::kStationary && labels.labels[beam] == PointLabel::kMoving) labels.labels[beam] = PointLabel::kStationary;
      if (segment.label == PointLabel::kMoving) labels.labels[beam] = PointLabel::kMoving;
    }
  }
  for (std::size_t t = 0; t < tracks_.size(); ++t)
    if (tracks_[t].confirmed)
      for (const std::uint16_t beam : shares_.beams_of_track[t]) labels.labels[beam] = PointLabel::kMoving;
  return labels;
}

flow::TrackedObjects Tracker::describe(const flow::SegmentedScan& scan) const {
  flow::TrackedObjects objects{scan.stamp_ns, scan.sequence, scan.map_from_odom, scan.odom_from_base.pose, {}, scan.map_id};
  objects.objects.reserve(tracks_.size());
  for (const Track& track : tracks_) objects.objects.push_back(described(track, scan.stamp_ns, config_));
  return objects;
}

void Tracker::take_up(const flow::TrackedObjects& objects) {
  tracks_.clear();
  for (const flow::TrackedObject& object : objects.objects) {
    next_id_ = std::max(next_id_, object.track_id.value + 1);
    if (object.confirmed) tracks_.push_back(resumed(object, config_));
  }
  last_stamp_ns_ = objects.stamp_ns;
  has_scan_ = true;
}

}  // namespace slammot::tracking
