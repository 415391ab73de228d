#include "services/tracking/rivals.hpp"

#include <algorithm>
#include <optional>

#include "common/association/gating.hpp"
#include "services/tracking/pairing.hpp"

namespace slammot::tracking {
namespace {

using association::kForbidden;
using association::kUnassigned;
using association::TrackKey;
using Eigen::Matrix2d;
using Eigen::Vector2d;

/// Only those without sides: where a vehicle is its sides tell.
bool is_rival(const Track& track) { return track.confirmed && !track.body.has_sides; }

association::MhtConfig mht_config(const TrackingConfig& config) {
  association::MhtConfig mht;
  mht.most_hypotheses = static_cast<std::size_t>(config.most_hypotheses);
  mht.scans_back = static_cast<std::size_t>(config.hypothesis_scans);
  return mht;
}

/// What one segment says if it is somebody who walks.
struct Walker {
  Vector2d centre_m = Vector2d::Zero();
  Matrix2d R = Matrix2d::Identity();         ///< If it is one alone, without the swing of its legs.
  double extent_m = 0.0;
};

/// One scan, as multiple hypotheses ask for it.
class ScanOfRivals {
 public:
  ScanOfRivals(const std::vector<Track>& tracks, const ScanView& view, const TrackingConfig& config,
               const std::function<bool(std::size_t, std::size_t)>& may_have)
      : tracks_(tracks), view_(view), config_(config), may_have_(may_have), models_(motion_models(config)) {
    for (std::size_t s = 0; s < view.scan().segments.size(); ++s) {
      const flow::Segment& segment = view.scan().segments[s];
      if (is_backdrop(segment, config) || segment.box_length_m > kWidestGroupM) continue;
      const bool is_near = std::any_of(tracks.begin(), tracks.end(), [&](const Track& track) {
        return is_rival(track) && (track.position_m() - segment.centroid_in_odom_m).norm() < config.widest_gate_m;
      });
      if (!is_near) continue;
      segments_.push_back(s);
      walkers_.push_back(walker_of(segment));
    }
  }

  std::size_t segment_of(std::size_t measurement) const { return segments_[measurement]; }
  std::size_t track_of(TrackKey key) const {
    return static_cast<std::size_t>(std::find_if(tracks_.begin(), tracks_.end(), [&](const Track& track) { return track.track_id.value == key; }) - tracks_.begin());
  }

  std::size_t measurement_count() const { return segments_.size(); }
  std::size_t capacity(std::size_t measurement) const { return walkers_[measurement].extent_m > kWidestOfOneM ? 2 : 1; }

  double pair_cost(TrackKey key, const SupposedMotion& supposed, std::size_t measurement, std::size_t sharers) const {
    constexpr double kSharingCost = 4.0;
    const std::size_t track = track_of(key);
    const std::size_t segment = segments_[measurement];
    const double cost = tracking::pair_cost(tracks_[track].body, supposed.estimate, view_.scan().segments[segment], config_);
    if (cost >= kCostOfLeavingOut || !may_have_(track, segment)) return kForbidden;
    return cost + (sharers > 0 ? kSharingCost : 0.0);
  }

  double miss_cost(TrackKey key, const SupposedMotion& supposed) const {
    constexpr double kHiddenCost = 8.0;
    const Visibility visibility = view_.visibility_of(tracks_[track_of(key)].body, supposed.estimate.mean.head<2>());
    return 2 * visibility.blocked > visibility.beams ? kHiddenCost : kCostOfLeavingOut;
  }

  SupposedMotion updated(TrackKey key, const SupposedMotion& supposed, std::size_t measurement, std::size_t sharers) const {
    const Walker& walker = walkers_[measurement];
    const double unseen_s = static_cast<double>(view_.scan().stamp_ns - tracks_[track_of(key)].last_seen_ns) * 1e-9;
    const Matrix2d R = noise_m2(walker, sharers) + gait_variance_m2(unseen_s, config_) * Matrix2d::Identity();
    SupposedMotion next{supposed.motion, filters::imm_update(models_, supposed.motion, walker.centre_m, R).posterior, {}};
    next.estimate = filters::imm_combine(models_, next.motion);
    return next;
  }

  SupposedMotion missed(TrackKey, const SupposedMotion& supposed) const { return {supposed.motion, supposed.motion, supposed.estimate}; }

  bool are_same(const SupposedMotion& a, const SupposedMotion& b) const {
    constexpr double kSame = 0.3;
    return association::mahalanobis_squared<4>((a.estimate.mean - b.estimate.mean).head<4>(), a.estimate.covariance.topLeftCorner<4, 4>()) < kSame;
  }

 private:
  static constexpr double kWidestOfOneM = 0.6;  ///< What is wider may be two.
  static constexpr double kWidestGroupM = 3.0;  ///< What is wider is nobody who walks.

  Walker walker_of(const flow::Segment& segment) {
    points_m_.clear();
    for (const std::uint16_t beam : segment.beams) points_m_.push_back(view_.point_in_odom_m(beam));
    const Glimpse glimpse{points_m_, view_.laser_in_odom_m(), view_.beam_step_rad(), Edge::kOpen, Edge::kOpen, std::nullopt};
    const BodyMeasurement measurement = measure_blob({}, glimpse, config_);
    return {measurement.centre_m,
            measurement.covariance_m2 + pose_covariance_at(segment.centroid_in_odom_m, view_.scan()),
            extent_of(points_m_)};
  }

  /// Of several who are seen as one, each is somewhere in it.
  static Matrix2d noise_m2(const Walker& walker, std::size_t sharers) {
    return sharers == 0 ? walker.R : Matrix2d(walker.R + 0.25 * walker.extent_m * walker.extent_m * Matrix2d::Identity());
  }

  const std::vector<Track>& tracks_;
  const ScanView& view_;
  const TrackingConfig& config_;
  const std::function<bool(std::size_t, std::size_t)>& may_have_;
  filters::ModelSet models_;
  std::vector<std::size_t> segments_;
  std::vector<Walker> walkers_;
  std::vector<Vector2d> points_m_;
};

}  // namespace

Rivals::Rivals(const TrackingConfig& config) : config_(config), hypotheses_(mht_config(config)) {}

void Rivals::predict(double time_s) {
  const filters::ModelSet models = motion_models(config_);
  hypotheses_.change_alternatives([&](TrackKey, SupposedMotion& supposed) {
    supposed.motion = filters::imm_predict(models, supposed.motion, time_s);
    supposed.estimate = filters::imm_combine(models, supposed.motion);
  });
}

/// The tracks' own motion is that of the likeliest hypothesis.
void Rivals::keep_up(const std::vector<Track>& tracks) {
  for (const TrackKey key : hypotheses_.keys())
    if (std::none_of(tracks.begin(), tracks.end(), [&](const Track& track) { return track.track_id.value == key && is_rival(track); }))
      hypotheses_.remove(key);
  for (const Track& track : tracks) {
    if (!is_rival(track)) continue;
    const SupposedMotion own{track.motion, track.motion, track.estimate};
    if (has(track)) hypotheses_.set_best(track.track_id.value, own);
    else hypotheses_.add(track.track_id.value, own);
  }
}

std::vector<std::size_t> Rivals::decide(std::vector<Track>& tracks, const ScanView& view,
                                        const std::function<bool(std::size_t, std::size_t)>& may_have) {
  keep_up(tracks);
  const ScanOfRivals scan(tracks, view, config_, may_have);
  hypotheses_.step(scan);
  std::vector<std::size_t> segment_of_track(tracks.size(), kUnassigned);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    Track& track = tracks[t];
    if (!has(track)) continue;
    const std::size_t measurement = hypotheses_.measurement_of(track.track_id.value);
    if (measurement != kUnassigned) segment_of_track[t] = scan.segment_of(measurement);
    if (!hypotheses_.is_revised(track.track_id.value)) continue;
    track.motion = hypotheses_.best(track.track_id.value).predicted;
    track.walks_on = false;  // the hypotheses have all modes
    track.estimate = filters::imm_combine(motion_models(config_), track.motion);
  }
  return segment_of_track;
}

}  // namespace slammot::tracking
