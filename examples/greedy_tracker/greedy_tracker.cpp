#include "examples/greedy_tracker/greedy_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "common/association/gating.hpp"
#include "common/filters/kalman.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::greedy_tracker {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using flow::PointLabel;
using flow::Segment;
using PositionOfState = Eigen::Matrix<double, 2, 4>;

double seconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-9; }

/// Prediction with a constant velocity and continuous white acceleration: Bar-Shalom, Li,
/// Kirubarajan 2001, section 6.2.2.
filters::Gaussian<4> predicted(const filters::Gaussian<4>& state, double time_s, double density) {
  Matrix4d F = Matrix4d::Identity();
  F.topRightCorner<2, 2>() = time_s * Matrix2d::Identity();
  Matrix4d Q;
  Q << Matrix2d::Identity() * time_s * time_s * time_s / 3.0,
      Matrix2d::Identity() * time_s * time_s / 2.0, Matrix2d::Identity() * time_s * time_s / 2.0,
      Matrix2d::Identity() * time_s;
  return filters::kalman_predict<4>(state, F, density * Q);
}

Matrix2d measurement_covariance(const Segment& segment, const GreedyTrackerConfig& config) {
  const double sigma_m =
      config.position_sigma_m + config.position_sigma_per_m * segment.box_length_m;
  return segment.centroid_covariance_m2 + sigma_m * sigma_m * Matrix2d::Identity();
}

/// Initializes the labels with those of detection.
void begin_labels(const flow::SegmentedScan& scan, flow::ScanLabels& labels) {
  labels.stamp_ns = scan.stamp_ns;
  labels.sequence = scan.sequence;
  labels.scanner_id = scan.scanner_id;
  labels.restored.clear();
  labels.labels = scan.labels;
}

bool may_begin(const Segment& segment, const GreedyTrackerConfig& config) {
  return segment.label == PointLabel::kMoving &&
         segment.beams.size() >= config.min_initiation_points;
}

void label(const Segment& segment, PointLabel label, flow::ScanLabels& labels) {
  for (const std::uint16_t beam : segment.beams) labels.labels[beam] = label;
}

void set_header(const flow::SegmentedScan& scan, flow::TrackedObjects& objects) {
  objects.stamp_ns = scan.stamp_ns;
  objects.sequence = scan.sequence;
  objects.map_from_odom = scan.map_from_odom;
  objects.odom_from_base = scan.odom_from_base.pose;
  objects.map_id = scan.map_id;
  objects.odom_id = scan.odom_id;
}

}  // namespace

const stages::TrackingResult& GreedyTracker::step(const flow::SegmentedScan& scan) {
  begin_labels(scan, result_.labels);
  if (scans_ == 0 || scan.stamp_ns >= last_stamp_ns_) {
    predict(scan.stamp_ns);
    const std::vector<std::size_t> paired = segment_of_each_track(scan.segments);
    // Only points of confirmed tracks stay out of the map. Other moving points correct cells that
    // the map falsely holds to be free.
    for (const Segment& segment : scan.segments)
      if (segment.label != PointLabel::kUnknown)
        label(segment, PointLabel::kStationary, result_.labels);
    for (std::size_t t = 0; t < paired.size(); ++t) {
      if (paired[t] == kNone) continue;
      correct(tracks_[t], scan.segments[paired[t]], scan.stamp_ns);
      if (tracks_[t].object.confirmed)
        label(scan.segments[paired[t]], PointLabel::kMoving, result_.labels);
    }
    for (std::size_t s = 0; s < scan.segments.size(); ++s)
      if (std::ranges::count(paired, s) == 0 && may_begin(scan.segments[s], config_))
        begin_track(scan.segments[s], scan.stamp_ns);
    delete_unseen(scan.stamp_ns);
    ++scans_;
  } else {
    ++late_scans_;
  }
  set_header(scan, result_.objects);
  result_.objects.objects.clear();
  for (const Track& track : tracks_) result_.objects.objects.push_back(described(track));
  return result_;
}

void GreedyTracker::predict(std::int64_t stamp_ns) {
  for (Track& track : tracks_)
    track.state =
        predicted(track.state, seconds(stamp_ns - last_stamp_ns_), config_.acceleration_density);
  last_stamp_ns_ = stamp_ns;
}

/// Greedy assignment: of all pairs inside the gate the nearest first. Index of each track's
/// segment, or kNone.
std::vector<std::size_t> GreedyTracker::segment_of_each_track(
    const std::vector<Segment>& segments) const {
  const double gate = association::planar_gate(config_.gate_share);
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;  // squared distance, track,
                                                                    // segment
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (segments[s].label != PointLabel::kMoving) continue;
      const Vector2d residual_m =
          segments[s].box_centre_in_odom_m - tracks_[t].state.mean.head<2>();
      const Matrix2d S = tracks_[t].state.covariance.topLeftCorner<2, 2>() +
                         measurement_covariance(segments[s], config_);
      const double squared = association::mahalanobis_squared<2>(residual_m, S);
      if (squared <= gate) pairs.emplace_back(squared, t, s);
    }
  }
  std::ranges::sort(pairs);
  std::vector<std::size_t> segment_of(tracks_.size(), kNone);
  for (const auto& [squared, t, s] : pairs)
    if (segment_of[t] == kNone && std::ranges::count(segment_of, s) == 0) segment_of[t] = s;
  return segment_of;
}

void GreedyTracker::correct(Track& track, const Segment& segment, std::int64_t stamp_ns) {
  flow::TrackedObject& object = track.object;
  const PositionOfState H = PositionOfState::Identity();
  track.state = filters::kalman_update<4, 2>(track.state, segment.box_centre_in_odom_m, H,
                                             measurement_covariance(segment, config_))
                    .posterior;
  if (segment.box_length_m > object.length_m) object.heading_in_odom_rad = segment.box_heading_rad;
  object.length_m = std::max(object.length_m, segment.box_length_m);
  object.width_m = std::max(object.width_m, segment.box_width_m);
  object.last_seen_ns = stamp_ns;
  const bool has_travelled =
      (track.state.mean.head<2>() - track.first_m).norm() >= config_.least_travel_m;
  if (++track.hits < config_.least_hits || !has_travelled || object.confirmed) return;
  object.confirmed = true;
  ++tracks_confirmed_;
}

void GreedyTracker::begin_track(const Segment& segment, std::int64_t stamp_ns) {
  const double sigma_mps = 0.5 * config_.fastest_mps;
  Track& track = tracks_.emplace_back();
  track.first_m = track.state.mean.head<2>() = segment.box_centre_in_odom_m;
  track.state.covariance.topLeftCorner<2, 2>() = measurement_covariance(segment, config_);
  track.state.covariance.bottomRightCorner<2, 2>() = sigma_mps * sigma_mps * Matrix2d::Identity();
  track.object.track_id = {next_id_++};
  track.object.heading_in_odom_rad = segment.box_heading_rad;
  track.object.length_m = segment.box_length_m;
  track.object.width_m = segment.box_width_m;
  track.object.mode_probability = {1.0, 0.0, 0.0};
  track.object.first_seen_ns = track.object.last_seen_ns = stamp_ns;
}

void GreedyTracker::delete_unseen(std::int64_t stamp_ns) {
  std::erase_if(tracks_, [&](const Track& track) {
    return seconds(stamp_ns - track.object.last_seen_ns) >
           (track.object.confirmed ? config_.longest_unseen_s : config_.longest_unseen_tentative_s);
  });
}

/// The heading is that of the velocity if the object moves. For a box across the velocity, length
/// and width are exchanged.
flow::TrackedObject GreedyTracker::described(const Track& track) const {
  constexpr double kStandsBelow_mps = 0.5;
  constexpr double kPathStep_s = 0.5;
  constexpr int kPathSteps = 6;
  flow::TrackedObject object = track.object;
  object.existence = object.confirmed ? 0.9 : 0.5;
  object.position_in_odom_m = track.state.mean.head<2>();
  object.velocity_in_odom_mps = track.state.mean.tail<2>();
  object.covariance = track.state.covariance;
  object.motion = object.velocity_in_odom_mps.norm() < kStandsBelow_mps ? flow::Motion::kStopped
                                                                        : flow::Motion::kMoving;
  if (object.motion == flow::Motion::kMoving) {
    object.heading_in_odom_rad =
        std::atan2(object.velocity_in_odom_mps.y(), object.velocity_in_odom_mps.x());
    if (std::abs(std::cos(object.heading_in_odom_rad - track.object.heading_in_odom_rad)) <
        std::numbers::sqrt2 / 2.0)
      std::swap(object.length_m, object.width_m);
  }
  for (int step = 1; object.confirmed && step <= kPathSteps; ++step) {
    const filters::Gaussian<4> there =
        predicted(track.state, step * kPathStep_s, config_.acceleration_density);
    object.predicted_path.push_back(
        {step * kPathStep_s, there.mean.head<2>(), there.covariance.topLeftCorner<2, 2>()});
  }
  return object;
}

std::map<std::string, std::uint64_t> GreedyTracker::named_counters() const {
  return {{"scans", scans_},
          {"late_scans", late_scans_},
          {"tracks_begun", next_id_ - 1},
          {"tracks_confirmed", tracks_confirmed_}};
}

}  // namespace slammot::greedy_tracker
