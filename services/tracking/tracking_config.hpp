#pragma once

namespace slammot::tracking {

struct TrackingConfig {
  // Motion.
  double velocity_noise_density = 0.1;  ///< Of white acceleration while cruising, m^2/s^3.
  double jerk_noise_density = 3.0;      ///< While manoeuvring, m^2/s^5.
  double idle_acceleration_mps2 = 0.5;  ///< One sigma of the acceleration that cruising leaves
                                        ///< open.
  bool coordinated_turn = false;  ///< Whether turning is a mode of its own, of vehicles that surely
                                  ///< move.
  double turn_noise_density = 3.0;  ///< While turning, m^2/s^5.
  double mean_stay_s = 3.0;         ///< Mean time in one of the modes.
  double fastest_mps = 20.0;        ///< One sigma of a new track's speed is half of this.
  double stopped_below_mps = 0.3;   ///< Slower for a while is stopped,
  double moving_above_mps = 0.6;    ///< and faster moving again.
  double standing_memory_s = 0.5;   ///< For which measurements tell whether something stands still.
  double detection_sigmas = 2.0;    ///< Of its velocity: what is faster surely moves.
  bool formations = false;  ///< Whether vehicles of a queue that are hidden go on as the others do.

  // Measurement.
  double range_noise_m = 0.03;       ///< One sigma at the scanner,
  double range_noise_per_m = 0.001;  ///< and what each metre of range adds.
  double shape_noise_m = 0.03;       ///< One sigma of how far an edge may lie off a box.
  double blob_noise_share = 0.2;     ///< Of its extent: how the middle of something without known
                                     ///< sides wanders.
  double gait_noise_m = 0.1;  ///< One sigma of how far who walks is off the middle of the legs that
                              ///< are seen,
  double gait_memory_s = 0.12;  ///< and for how long that is much the same.

  // Association.
  double gate_share = 0.999;   ///< Of true pairs that the gate lets through.
  double gate_margin_m = 0.3;  ///< Points this near a predicted body are its own.
  double widest_gate_m = 3.0;
  double other_label_cost = 4.0;        ///< Added for a segment that detection does not hold to be
                                        ///< moving.
  double larger_body_cost_per_m = 1.0;  ///< Added for each metre by which a segment outgrows the
                                        ///< body.
  int most_hypotheses = 1;  ///< Of whose segments are whose among those who walk close together; 1:
                            ///< decided at once.
  int hypothesis_scans = 15;  ///< After which such a decision is final.

  // Existence: log-odds, Wang 2004, Eqs. (5.1)-(5.5).
  double birth_score = -1.0;
  double moving_hit_score = 0.8;        ///< A segment that moves,
  double other_hit_score = 0.1;         ///< or any other, where the track should be.
  double contradiction_score = -0.5;    ///< It should be moving, but most of its echoes come from
                                        ///< what stood there before.
  double contradicted_above_mps = 1.5;  ///< What is faster does not lie on what stood there before.
  double mapped_memory_s = 0.8;         ///< With more scans of these last moments than this share
  double most_mapped_share = 0.6;  ///< in which it is where the map has something, what makes no
                                   ///< way is what the map has.
  double mapped_score_per_s = -6.0;
  double occluded_score_per_s = -1.0;
  double out_of_view_score_per_s = -30.0;
  double passed_beam_score = -0.6;    ///< For each beam that went through where the body should be,
  double most_passed_score = -2.0;    ///< in one scan at most.
  double most_surprise_sigmas = 6.0;  ///< Echoes so far off a confirmed track's prediction
  double least_surprise_m = 0.6;      ///< and by so much are not its own,
  double surprise_score = -0.5;       ///< and speak against it.
  double implausible_score = -1.0;    ///< Its shape or speed is that of nothing on the road.
  int least_points_at_birth = 2;
  double most_score = 8.0;
  double confirm_score = 2.0;
  double reject_score = -3.0;
  int least_hits = 5;                  ///< Before a track can be confirmed.
  double compare_after_s = 0.8;        ///< Between the scans that are compared to tell what moved.
  double compare_fast_after_s = 0.25;  ///< The same for what moves fast, which need not be waited
                                       ///< for,
  double compare_slow_after_s = 1.6;   ///< and for what moves slowly.
  double evidence_memory_s = 0.5;      ///< For which echoes that tell of motion count.
  double least_moved_votes = 6.0;      ///< It must have so many that say that it has moved,
  double least_moved_share = 0.3;      ///< against those that say that it stood,
  double sure_moved_votes = 30.0;      ///< and either so many
  double sure_moved_share = 0.7;       ///< and such a share,
  double least_travel_m = 0.3;         ///< or must have come this far from where it began,
  double least_travel_sigmas = 3.0;    ///< and so many of its own standard deviations,
  double most_speed_sigma_mps = 0.5;  ///< with a velocity as well known as this, or, out of nowhere
                                      ///< and as predicted, as is published.
  double longest_unseen_s = 3.0;      ///< Without a segment before a track ends, however well it is
                                      ///< explained.
  double longest_unseen_published_s = 0.02;  ///< After which it is followed, but not published as
                                             ///< confirmed.
  double publish_score = 0.0;                ///< Nor with a score below this,
  double most_speed_sigma_published_mps = 0.7;  ///< or a velocity less well known than this, as
                                                ///< after it was hidden.
  double longest_unseen_tentative_s = 0.4;
  double longest_tentative_s = 1.5;  ///< What has not proven to move by then is rejected; what
                                     ///< seems to, after twice that.

  // Body.
  double box_from_extent_m = 1.2;   ///< Larger objects have sides; smaller ones are blobs.
  double box_from_speed_mps = 0.8;  ///< Their heading is that of motion above this speed.
  double size_scale = 1.0;  ///< Of all road users, against real ones: models on a laboratory's
                            ///< floor.
  double longest_body_m = 18.0;
  double stride_m = 0.55;                ///< Small things so near to someone who walks are a leg.
  double least_travel_to_stand_m = 1.5;  ///< For each time that it has come so far
  double longest_stand_s = 2.0;  ///< something may stand so long, before it is held never to have
                                 ///< moved.
  double merge_overlap_m = 0.3;  ///< Bodies that reach this deep into each other with like motion
                                 ///< are one.
};

/// One sigma of what an echo from so far away errs by along its beam.
inline double echo_sigma_m(double range_m, const TrackingConfig& config) {
  return config.range_noise_m + config.range_noise_per_m * range_m;
}

/// Whether these settings are of a place where nothing larger than people moves: what no beam
/// answered before may be taken for a leg there. On a road bushes, flat walls and the ground come
/// and go in the same way.
inline bool only_people_move(const TrackingConfig& config) {
  return config.longest_body_m < 3.0 * config.size_scale;
}

}  // namespace slammot::tracking
