#include "services/tracking/competing_tracks.hpp"

#include <algorithm>
#include <optional>

#include "common/association/gating.hpp"
#include "services/tracking/association_cost.hpp"

namespace slammot::tracking {
namespace {

using association::kForbidden;
using association::kUnassigned;
using association::TrackKey;
using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Scans after which an assignment is final: docs/decisions/association.md.
constexpr std::size_t kHypothesisScans = 15;

/// Blobs only: the sides of a vehicle tell where it is.
bool may_compete(const Track& track) {
  return track.existence.confirmed && track.extent.box() == nullptr;
}

association::MhtConfig mht_config(const TrackingConfig& config) {
  association::MhtConfig mht;
  mht.most_hypotheses = static_cast<std::size_t>(config.association.most_hypotheses);
  mht.scans_back = kHypothesisScans;
  return mht;
}

/// A segment as a measurement of a pedestrian.
struct PedestrianMeasurement {
  Vector2d centre_m = Vector2d::Zero();
  Matrix2d R = Matrix2d::Identity();  ///< Of a single pedestrian, without the gait.
  double extent_m = 0.0;
};

/// One scan, in the form that association::MultipleHypotheses asks for.
class CompetingTracksScan {
 public:
  CompetingTracksScan(const std::vector<Track>& tracks, const ScanView& view,
                      const TrackingConfig& config,
                      const std::function<bool(std::size_t, std::size_t)>& is_allowed)
      : tracks_(tracks),
        view_(view),
        config_(config),
        is_allowed_(is_allowed),
        models_(motion_models(config)) {
    for (std::size_t s = 0; s < view.scan().segments.size(); ++s) {
      const flow::Segment& segment = view.scan().segments[s];
      if (is_backdrop(segment, config) || segment.box_length_m > kWidestGroupM) continue;
      const bool is_near = std::any_of(tracks.begin(), tracks.end(), [&](const Track& track) {
        return may_compete(track) && (track.position_m() - segment.centroid_in_odom_m).norm() <
                                         config.association.widest_gate_m;
      });
      if (!is_near) continue;
      segments_.push_back(s);
      measurements_.push_back(pedestrian_measurement_of(segment));
    }
  }

  std::size_t segment_of(std::size_t measurement) const { return segments_[measurement]; }
  std::size_t track_of(TrackKey key) const {
    return static_cast<std::size_t>(
        std::find_if(tracks_.begin(), tracks_.end(),
                     [&](const Track& track) { return track.track_id.value == key; }) -
        tracks_.begin());
  }

  std::size_t measurement_count() const { return segments_.size(); }
  std::size_t capacity(std::size_t measurement) const {
    return measurements_[measurement].extent_m > kWidestOfOneM ? 2 : 1;
  }

  double pair_cost(TrackKey key, const HypothesisMotion& hypothesis, std::size_t measurement,
                   std::size_t sharers) const {
    constexpr double kSharingCost = 4.0;
    const std::size_t track = track_of(key);
    const std::size_t segment = segments_[measurement];
    const double cost = association_cost(tracks_[track].extent.outline, hypothesis.estimate,
                                         view_.scan().segments[segment], config_);
    if (cost >= kCostOfMiss || !is_allowed_(track, segment)) return kForbidden;
    return cost + (sharers > 0 ? kSharingCost : 0.0);
  }

  double miss_cost(TrackKey key, const HypothesisMotion& hypothesis) const {
    constexpr double kHiddenCost = 8.0;
    const Visibility visibility =
        view_.visibility_of(tracks_[track_of(key)].footprint(), hypothesis.estimate.mean.head<2>());
    return 2 * visibility.blocked > visibility.beams ? kHiddenCost : kCostOfMiss;
  }

  HypothesisMotion updated(TrackKey key, const HypothesisMotion& hypothesis,
                           std::size_t measurement, std::size_t sharers) const {
    const PedestrianMeasurement& pedestrian = measurements_[measurement];
    const double unseen_s =
        static_cast<double>(view_.scan().stamp_ns - tracks_[track_of(key)].history.last_seen_ns) *
        1e-9;
    const Matrix2d R =
        noise_m2(pedestrian, sharers) + gait_variance_m2(unseen_s, config_) * Matrix2d::Identity();
    HypothesisMotion next{
        hypothesis.motion,
        filters::imm_update(models_, hypothesis.motion, pedestrian.centre_m, R).posterior,
        {}};
    next.estimate = filters::imm_combine(models_, next.motion);
    return next;
  }

  HypothesisMotion missed(TrackKey, const HypothesisMotion& hypothesis) const {
    return {hypothesis.motion, hypothesis.motion, hypothesis.estimate};
  }

  bool are_same(const HypothesisMotion& a, const HypothesisMotion& b) const {
    constexpr double kSame = 0.3;
    return association::mahalanobis_squared<4>((a.estimate.mean - b.estimate.mean).head<4>(),
                                               a.estimate.covariance.topLeftCorner<4, 4>()) < kSame;
  }

 private:
  static constexpr double kWidestOfOneM = 0.6;  ///< A wider segment may be two pedestrians.
  static constexpr double kWidestGroupM = 3.0;  ///< A wider segment is not of pedestrians.

  PedestrianMeasurement pedestrian_measurement_of(const flow::Segment& segment) {
    points_m_.clear();
    for (const std::uint16_t beam : segment.beams) points_m_.push_back(view_.point_in_odom_m(beam));
    const Observation observation{
        points_m_,   view_.laser_in_odom_m(), view_.beam_step_rad(), Edge::kOpen, Edge::kOpen,
        std::nullopt};
    const BlobMeasurement measurement = measure_blob({}, observation, config_);
    return {
        measurement.centre_m,
        measurement.covariance_m2 + pose_covariance_at(segment.centroid_in_odom_m, view_.scan()),
        largest_span_m(points_m_)};
  }

  /// If several share a segment, each is somewhere in it.
  static Matrix2d noise_m2(const PedestrianMeasurement& pedestrian, std::size_t sharers) {
    return sharers == 0 ? pedestrian.R
                        : Matrix2d(pedestrian.R + 0.25 * pedestrian.extent_m * pedestrian.extent_m *
                                                      Matrix2d::Identity());
  }

  const std::vector<Track>& tracks_;
  const ScanView& view_;
  const TrackingConfig& config_;
  const std::function<bool(std::size_t, std::size_t)>& is_allowed_;
  filters::ModelSet models_;
  std::vector<std::size_t> segments_;
  std::vector<PedestrianMeasurement> measurements_;
  std::vector<Vector2d> points_m_;
};

}  // namespace

CompetingTracks::CompetingTracks(const TrackingConfig& config)
    : config_(config), hypotheses_(mht_config(config)) {}

void CompetingTracks::predict(double time_s) {
  const filters::ModelSet models = motion_models(config_);
  hypotheses_.change_alternatives([&](TrackKey, HypothesisMotion& hypothesis) {
    hypothesis.motion = filters::imm_predict(models, hypothesis.motion, time_s);
    hypothesis.estimate = filters::imm_combine(models, hypothesis.motion);
  });
}

/// Removes tracks that no longer compete, adds new ones, and sets the likeliest hypothesis to the
/// track's own motion.
void CompetingTracks::synchronise(const std::vector<Track>& tracks) {
  for (const TrackKey key : hypotheses_.keys())
    if (std::none_of(tracks.begin(), tracks.end(), [&](const Track& track) {
          return track.track_id.value == key && may_compete(track);
        }))
      hypotheses_.remove(key);
  for (const Track& track : tracks) {
    if (!may_compete(track)) continue;
    const HypothesisMotion own{track.kinematics.mixture, track.kinematics.mixture,
                               track.kinematics.estimate};
    if (has(track)) hypotheses_.set_best(track.track_id.value, own);
    else hypotheses_.add(track.track_id.value, own);
  }
}

std::vector<std::size_t> CompetingTracks::decide(
    std::vector<Track>& tracks, const ScanView& view,
    const std::function<bool(std::size_t, std::size_t)>& is_allowed) {
  synchronise(tracks);
  const CompetingTracksScan scan(tracks, view, config_, is_allowed);
  hypotheses_.step(scan);
  std::vector<std::size_t> segment_of_track(tracks.size(), kUnassigned);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    Track& track = tracks[t];
    if (!has(track)) continue;
    const std::size_t measurement = hypotheses_.measurement_of(track.track_id.value);
    if (measurement != kUnassigned) segment_of_track[t] = scan.segment_of(measurement);
    if (!hypotheses_.is_revised(track.track_id.value)) continue;
    track.kinematics.mixture = hypotheses_.best(track.track_id.value).predicted;
    track.kinematics.cruises_only = false;  // hypotheses have all modes
    track.kinematics.estimate =
        filters::imm_combine(motion_models(config_), track.kinematics.mixture);
  }
  return segment_of_track;
}

}  // namespace slammot::tracking
