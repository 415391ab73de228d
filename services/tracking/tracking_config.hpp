#pragma once

namespace slammot::tracking {

struct TrackingConfig {
  // Motion.
  double velocity_noise_density = 0.5;      ///< Of white acceleration while cruising, m^2/s^3.
  double jerk_noise_density = 6.0;          ///< While manoeuvring, m^2/s^5.
  double idle_acceleration_mps2 = 1.0;      ///< One sigma of the acceleration that cruising leaves open.
  double mean_stay_s = 1.5;                 ///< Mean time in one of the two.
  double fastest_mps = 20.0;                ///< One sigma of a new track's speed is half of this.
  double stopped_below_mps = 0.3;           ///< Slower for a while is stopped,
  double moving_above_mps = 0.6;            ///< and faster moving again.

  // Measurement.
  double range_noise_m = 0.03;              ///< One sigma at the scanner,
  double range_noise_per_m = 0.001;         ///< and what each metre of range adds.
  double shape_noise_m = 0.05;              ///< One sigma of how far an edge may lie off a box.
  double blob_noise_share = 0.2;            ///< Of its extent: how the middle of something without known sides wanders.

  // Association.
  double gate_share = 0.999;                ///< Of true pairs that the gate lets through.
  double gate_margin_m = 0.3;               ///< Points this near a predicted body are its own.
  double widest_gate_m = 3.0;
  double other_label_cost = 4.0;            ///< Added for a segment that detection does not hold to be moving.
  double larger_body_cost_per_m = 1.0;      ///< Added for each metre by which a segment outgrows the body.

  // Existence: log-odds, Wang 2004, Eqs. (5.1)-(5.5).
  double birth_score = -1.0;
  double moving_hit_score = 0.8;            ///< A segment that moves,
  double other_hit_score = 0.1;             ///< or any other, where the track should be.
  double contradiction_score = -0.3;        ///< It should be moving, but stands where the map knows something that stands.
  double idle_score = -0.1;                 ///< It no longer contradicts the map, and has never
  double travel_to_trust_m = 3.0;           ///< come so far
  int moving_hits_to_trust = 20;            ///< nor contradicted the map in so many scans.
  double occluded_score_per_s = -1.0;
  double out_of_view_score_per_s = -30.0;
  double passed_beam_score = -0.6;          ///< For each beam that went through where the body should be,
  double most_passed_score = -2.0;          ///< in one scan at most.
  int least_points_at_birth = 2;
  double most_score = 8.0;
  double confirm_score = 2.0;
  double reject_score = -3.0;
  int least_hits = 5;                       ///< Before a track can be confirmed.
  double least_moving_share = 0.6;          ///< Of its scans that contradicted the map.
  double least_travel_m = 0.35;             ///< It must have come this far from where it began,
  double least_travel_per_extent = 0.2;     ///< and this share of its extent,
  double least_travel_sigmas = 3.0;         ///< and so many of its own standard deviations.
  double longest_unseen_s = 3.0;            ///< Without a segment before a track ends, however well it is explained.
  double longest_unseen_published_s = 1.0;  ///< After which it is followed, but not published as confirmed.
  double publish_score = 0.0;               ///< Nor with a score below this.
  double longest_unseen_tentative_s = 0.4;
  double longest_tentative_s = 1.5;         ///< What has not proven to move by then is rejected.

  // Body.
  double box_from_extent_m = 1.2;           ///< Larger objects have sides; smaller ones are blobs.
  double box_from_speed_mps = 0.8;          ///< Their heading is that of motion above this speed.
  double longest_body_m = 18.0;
  double merge_overlap_m = 0.3;             ///< Bodies that reach this deep into each other with like motion are one.
};

}  // namespace slammot::tracking
