#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/filters/imm.hpp"
#include "common/filters/move_stop.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/memory/recycling_queue.hpp"
#include "services/tracking/body.hpp"
#include "services/tracking/object_class.hpp"
#include "services/tracking/road_users.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Echoes that say that an object has moved, comparing scans, and such that say that it stood.
struct MotionEvidence {
  double moved = 0.0;
  double stood = 0.0;
  double undecided = 0.0;
};

/// Echoes since something was first seen, and of them such as say where it has been.
struct TentativeEvidence {
  double seen = 0.0;
  double in_free_space = 0.0;  ///< That contradict the map: from where it has seen through.
  double stood = 0.0;          ///< From where an earlier scan had an echo, too.
};

/// Where a scan put the centre of a body.
struct MeasuredCentre {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
};

/// A glimpse and what it refers to, for later.
struct StoredObservation {
  std::int64_t stamp_ns = 0;                 ///< Of its beams, not of the scan.
  std::vector<Eigen::Vector2d> points_m;     ///< Of the glimpse, whose own may be gone.
  Observation observation;
  Eigen::Matrix2d pose_covariance_m2 = Eigen::Matrix2d::Zero();

  /// The glimpse of the points that are kept, for as long as they are.
  Observation with_points() const;
};

/// How many of the beams between the outermost echoes of a thing were not answered, of the last moments.
struct ResponseRate {
  double missed = 0.0;
  double asked = 0.0;

  /// Of the beams that meet it; before anything is known, few. At most 1.
  double unanswered_share() const;
};

/// The last glimpses of something, in the order in which they were added.
class ObservationHistory {
 public:
  static constexpr std::size_t kMost = 40;  ///< The oldest of more go.

  void add(std::int64_t stamp_ns, const Observation& observation, const Eigen::Matrix2d& pose_covariance_m2);
  void clear() { kept_.clear(); }
  std::size_t size() const { return kept_.size(); }
  /// 0: the oldest.
  const StoredObservation& operator[](std::size_t i) const { return kept_[i]; }

 private:
  memory::RecyclingQueue<StoredObservation> kept_;
};

/// How well the echoes of the last moments agree with the body.
struct Consistency {
  double off_sides_m = 0.0;  ///< Mean distance of echoes from its nearest side,
  double nis = 0.0;    ///< squared Mahalanobis distance of the measured centre from the predicted one.
  double weight = 0.0;       ///< In scans.
};

/// How far who walks is off the middle of what is seen of them: much where it is legs, little where it is a coat. Of the published
/// covariance only: gates must let pass the step of one who meets another.
struct Gait {
  std::optional<double> variance_m2;  ///< Along each axis; none as long as nothing is known.
};

/// How far sides and course are off the heading that the body is held to have, against what its filter takes for their noise: that
/// holds for round and far bodies in bends, and is far too much for a long flank on a straight road. Of the published covariance only.
struct HeadingNoise {
  double share = 1.0;   ///< Of the variance, in the last moments.
};

/// Beams that went through the inside of a body, and its echoes, a scan: through what is drawn around a part of it and something
/// else, or around several who walk, beams go.
struct BeamPassage {
  double through = 0.0;  ///< In the last moments.
  double met = 0.0;

  double share() const { return through / std::max(1.0, through + met); }
};

/// How far echoes lay off the sides of a body, since it was confirmed.
struct OutlineError {
  double shares = 0.0;   ///< Sum, an echo, of the share of what the settings take for it near by,
  double echoes = 0.0;   ///< of so many
  int scans = 0;         ///< in so many scans.
};

constexpr double kFastestWalkMps = 2.7;  ///< Who walks is slower than this.

/// Points of a track in a scan.
struct PastPoints {
  std::size_t scanner = 0;                   ///< Whose scan it was, as the tracker counts them.
  flow::RestoredPoints points;
};

/// One object that is followed, or supposed to be one.
struct Track {
  flow::TrackId track_id;
  filters::ImmState motion;
  filters::MotionState estimate;             ///< Of the modes together, as of the last predict or update,
  double time_offset_s = 0.0;                ///< and so long after the scan's stamp: when the beam that points at it was fired.
  filters::MoveStop move_stop;               ///< Whether it moves or stands; the estimate is that of the move hypothesis.
  std::optional<MeasuredCentre> measured;    ///< In the current scan, if it was seen.
  Eigen::Vector2d recentred_m = Eigen::Vector2d::Zero();  ///< By which the centre was moved in it, the same object drawn otherwise.
  Gait gait;                                 ///< Of who walks.
  HeadingNoise heading_noise;                     ///< Of what has sides.
  Consistency consistency;                       ///< Of the echoes with the body.
  BeamPassage beam_passage;                           ///< Of what is drawn as a vehicle.
  OutlineError outline_error;                        ///< Of the same.
  double range_m = 0.0;                      ///< From the laser, when it was last seen.
  double innovation_m = 0.0;                   ///< How far the last measured centre was from where it had been predicted.
  double misfit_s = 0.0;                      ///< For which nothing but its echoes, which lie off its sides, have kept it from being confirmed.
  double rejected_s = 0.0;                    ///< For which its echoes have been too far from where it must be.
  bool may_turn = false;                     ///< Whether turning is one of its modes,
  bool cruises_only = false;                     ///< and whether cruising is the only one; as of the last predict.
  Body body;
  double score = 0.0;                        ///< Log-odds of existence; Wang 2004, Eq. (5.2).
  bool confirmed = false;
  flow::Motion state = flow::Motion::kMoving;
  flow::ObjectClass object_class = flow::ObjectClass::kUnknown;  ///< The likeliest
  flow::ClassProbabilities class_probability = {};               ///< of these.
  SpeedsSeen speeds;                         ///< Since it was confirmed.
  int hits = 0;                              ///< Scans with echoes from it,
  int moving_hits = 0;                       ///< and such that contradicted the map.
  std::int64_t first_seen_ns = 0;
  std::int64_t last_seen_ns = 0;
  Eigen::Vector2d birth_position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d birth_covariance_m2 = Eigen::Matrix2d::Identity();
  MotionEvidence evidence;                   ///< Of the last moments, faded.
  TentativeEvidence tentative_evidence;                ///< Until it was confirmed.
  std::int64_t last_moving_ns = 0;           ///< When it was last faster than something that stands.
  double travelled_m = 0.0;                        ///< That it has come since it was confirmed, in steps that are more than jitter.
  Eigen::Vector2d anchor_m = Eigen::Vector2d::Zero();  ///< Where it last got away from;
  double claimed_travel_m = 0.0;                    ///< the way that it says to have gone since.
  bool is_refuted = false;                   ///< Earlier scans do not agree with its velocity.
  std::int64_t velocity_known_since_ns = 0;           ///< When its velocity was last known again, after it was too little known to be published.
  ResponseRate responses;
  double echoes = 0.0;                       ///< A scan, in the last moments.
  double mapped_share = 0.0;                 ///< Of the last moments, in which its echoes came from where the map has something.
  double without_progress_s = 0.0;           ///< Since the anchor was moved.
  double largest_extent_m = 0.0;
  double oversized_s = 0.0;                   ///< For which someone long known to walk has been given more echoes than one has.
  std::vector<Eigen::Vector2f> contour_in_odom_m;
  ObservationHistory observations;                        ///< What was seen of it until it was confirmed.
  memory::RecyclingQueue<PastPoints> past;   ///< Points of a track not yet confirmed, newest last.
  std::size_t scanner = 0;                   ///< The last one that had it in its field of view.
  double since_in_view_s = 0.0;                 ///< Since a scan that had it in its field of view.

  Eigen::Vector2d position_m() const { return estimate.mean.head<2>(); }
  Eigen::Vector2d velocity_mps() const { return estimate.mean.segment<2>(2); }
  Eigen::Matrix2d position_covariance_m2() const { return estimate.covariance.topLeftCorner<2, 2>(); }
  Eigen::Matrix2d velocity_covariance() const { return estimate.covariance.block<2, 2>(2, 2); }
};

/// After another glimpse, time_s after the one before, with so many echoes and so many beams between them without.
ResponseRate with_responses(ResponseRate responses, std::size_t echoes, int gaps, double time_s);

/// Cruising and manoeuvring: the modes of everything.
filters::ModelSet motion_models(const TrackingConfig& config);

/// One sigma of how far the velocity of a body with sides points off its length, as a share of the speed,
constexpr double kSlip = 0.08;
/// and besides, for the middle that is followed need not be the one about which it turns.
constexpr double kSlipMps = 0.3;

/// A body's axis is known from its sides where its variance is less.
constexpr double kKnownAxisRad2 = 0.02;

/// Log-odds at which it is sure which side of a body is its flank: twenty to one.
constexpr double kSureOdds = 3.0;

/// Whether it has sides, and is no bicycle.
bool is_vehicle(const Track& track);

/// Whether somebody is surely on foot, by the sizes and speeds that were seen of them until now: they go on to be for as long as the
/// filter says that they fly (decision 48), and get no sides: what is larger around them is company, or a wall (decision 51).
bool is_known_pedestrian(const Track& track);

/// Variance along each axis that the swing of the legs adds to a centre measured after_s (> 0) after the one before. The filter
/// takes the errors of all scans for independent; these fade exponentially, and so the closer scans follow each other the more
/// each has to add for the mean of many to be as uncertain as it is.
double gait_variance_m2(double after_s, const TrackingConfig& config);

/// With one more scan, in which the centre was measured so far from where it had been predicted, with this noise besides, time_s after
/// the one before.
Gait with_step(const Gait& before, const Eigen::Vector2d& innovation_m, const Eigen::Matrix2d& noise_m2, double time_s, const TrackingConfig& config);

/// With one more heading that was so far off the one held, with this variance of both together, time_s after the one before.
HeadingNoise with_heading(const HeadingNoise& before, double off_rad, double variance_rad2, double time_s);

/// With one more scan, time_s after the one before, in which so many beams went through the inside of the body and so many met it.
BeamPassage with_beams(const BeamPassage& before, int through, std::size_t met, double time_s);

/// A supposed object at these echoes, at rest as far as known. box_heading_rad: of the longer visible side. done_with: a track that
/// has ended, of which nothing but memory is used. It refers to the road users for as long as it is followed.
Track initiated(flow::TrackId track_id, std::int64_t stamp_ns, const Observation& observation, double box_heading_rad,
            const Eigen::Matrix2d& pose_covariance_m2, const TrackingConfig& config, const RoadUsers& road_users = kRoadUsersAnywhere, Track done_with = {});

/// Moves the track over time_s >= 0.
void predict(Track& track, double time_s, const TrackingConfig& config);

/// Corrects position, velocity, heading, size and motion state by the echoes that are its own. False, and nothing but the
/// heading changed, where they are too far from where a confirmed track must be.
bool update(Track& track, std::int64_t stamp_ns, const Observation& observation, const Eigen::Matrix2d& pose_covariance_m2,
            const TrackingConfig& config);

/// The one of two bodies with sides of which the echoes neither lie on its sides nor come from where it was predicted, if those of
/// the other do: of two that are drawn over each other the wrong one, however old. Null if neither or both are so.
const Track* inconsistent_one(const Track& a, const Track& b, const TrackingConfig& config);

/// Whether the velocity is known well enough to be published.
bool has_published_velocity(const Track& track, const TrackingConfig& config);

/// It is something, and moves: what it is follows from the speed that it has, too.
void confirm(Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

/// The same motion, of a body drawn anew around these echoes: what was followed was a piece of it.
void reinitialise_extent(Track& track, const Observation& observation, const TrackingConfig& config);

/// The same once nothing but its echoes, which lie off its sides, have kept it from being confirmed for a while: what hardly answers is begun
/// around a few echoes that lie anyhow, and never gets rid of that body. Decision 52.
void reinitialise_extent_if_misfit(Track& track, const Observation& observation, double time_s, const TrackingConfig& config);

/// The same place, and another velocity.
void restart_motion(Track& track, const Eigen::Vector2d& velocity_mps, double sigma_mps, const TrackingConfig& config);

/// Moves from now on as this says.
void move_as(Track& track, const filters::MotionState& state, const TrackingConfig& config);

/// Score after a scan with echoes, most of them in segments of this label, time_s after the one before.
void score_hit(Track& track, flow::PointLabel label, const MotionEvidence& evidence, double time_s, const TrackingConfig& config);

/// Score after time_s without echoes where it was predicted; what hides it excuses it.
void score_miss(Track& track, const Visibility& visibility, double time_s, const TrackingConfig& config);

/// Whether something has been, ever since it was first seen, where the map has seen through, and next to nothing of it where an
/// earlier scan had an echo: it has come there, even if the scans that tracking keeps had no view of the place. Of echoes fewer
/// than three this tells nothing, nor where only people move.
bool appeared_in_free_space(const Track& track, const TrackingConfig& config);

/// Score of a body with sides of which there were so many echoes, and through the inner part of which beams have passed: more of
/// them than echoes say that it is not there, or not such. What the map contradicts is something all the same, drawn too large.
void score_passed(Track& track, const Visibility& inner_part, std::size_t echoes, const TrackingConfig& config);

/// The part of the body that is filled even if size and place are off by a standard deviation, the place either way.
Body inner_part_of(const Track& track);

/// Whether what has been seen suffices to publish the track as an object that moves.
bool is_confirmable(const Track& track, const TrackingConfig& config);

/// Whether it would, but that its echoes do not lie on its sides. Decision 52.
bool misfits_only(const Track& track, const TrackingConfig& config);

/// Whether a track so old is no longer waited for to prove that it moves. What has travelled, and is surely fast, lacks but votes, or
/// does not know its speed well enough yet: it is waited for twice as long.
bool is_timed_out(const Track& track, double age_s, const TrackingConfig& config);

/// Whether it says to move and stays where it is: something that stands, seen now here, now there.
bool claims_motion_without_travel(const Track& track, const TrackingConfig& config);

/// Whether a confirmed track has stood, or gone unseen, for longer than the way that it has come speaks for. A vehicle that has come
/// least_travel_to_stand_m stands for as long as it is seen: it waits, or is parked.
bool has_stood_too_long(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config);

/// The track as it is published. done_with: an object that nobody needs any more, of which nothing but memory is used.
flow::TrackedObject published(const Track& track, std::int64_t stamp_ns, const TrackingConfig& config, flow::TrackedObject done_with = {});

/// A track as far as what was published of it tells.
Track track_from_message(const flow::TrackedObject& object, const TrackingConfig& config);

/// Adds the sizes of something of which they are surely known.
void learn_sizes(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

/// Adds how far echoes lay off the sides of a vehicle that was followed for long enough.
void learn_outline_error(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

/// Adds how far somebody who walked for long enough was off the middle of what was seen of them.
void learn_gait(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

double existence_of(double score);

}  // namespace slammot::tracking
