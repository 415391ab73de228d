#pragma once

#include "common/filters/model_set.hpp"

namespace slammot::tracking {

inline constexpr double kRangeNoisePerM = 0.001;  ///< Increase of the sigma of a range with range.
inline constexpr double kJerkNoiseDensity = 3.0;  ///< Of constant acceleration: white jerk
                                                  ///< [m^2/s^5].

/// Errors of echoes.
struct SensorNoise {
  double range_noise_m = 0.03;  ///< One sigma of a range at the scanner.
  double shape_noise_m = 0.03;  ///< One sigma of the distance of an edge from its box.
};

struct MotionConfig {
  double velocity_noise_density = 0.1;  ///< Of constant velocity: white acceleration [m^2/s^3].
  filters::Mixture mixture = filters::Mixture::kImm;  ///< How the modes are merged.
  bool move_stop = true;                              ///< Stop hypothesis beside the modes.
  bool coordinated_turn = false;                      ///< Third mode of vehicles that surely move.
  bool formations = false;         ///< Tracks a queue of vehicles as one augmented state.
  double fastest_mps = 20.0;       ///< Twice the sigma of a new track's speed.
  double stopped_below_mps = 0.3;  ///< Speed below which an object stops.
};

struct AssociationConfig {
  double gate_margin_m = 0.3;  ///< Points this near a predicted body belong to it.
  double widest_gate_m = 3.0;  ///< Upper limit of the gate, at any covariance.
  int most_hypotheses = 1;     ///< Of the assignment of close pedestrians; 1: nearest neighbour.
};

struct ExtentConfig {
  double size_scale = 1.0;          ///< Size of road users relative to real ones.
  double longest_body_m = 18.0;     ///< Longer segments are not objects.
  double box_from_extent_m = 1.2;   ///< Larger objects are boxes, smaller ones blobs.
  double box_from_speed_mps = 0.8;  ///< Above this speed the heading of a box is its course.
  double stride_m = 0.55;           ///< Small segments this near to a pedestrian are a leg.
  double merge_overlap_m = 0.3;     ///< Tracks that overlap this deep, with like motion, merge.
};

/// Log-odds of existence (Wang 2004, Eqs. 5.1-5.5) and the limits of a track's life.
struct ExistenceConfig {
  double contradicted_above_mps = 1.5;   ///< Faster objects do not lie on what stood before.
  double least_travel_m = 0.3;           ///< Distance from birth for confirmation.
  double least_travel_to_stand_m = 1.5;  ///< Distance travelled that allows kLongestStandS more.
  double least_surprise_m = 0.6;         ///< Least distance of an outlier from the prediction.
  double longest_unseen_s = 6.0;         ///< A confirmed track ends after this.
};

struct PublicationConfig {
  double longest_unseen_published_s = 5.0;      ///< Published as occluded for this long.
  double most_speed_sigma_published_mps = 0.7;  ///< With a larger sigma of the velocity neither.
};

struct TrackingConfig {
  SensorNoise sensor;
  MotionConfig motion;
  AssociationConfig association;
  ExtentConfig extent;
  ExistenceConfig existence;
  PublicationConfig publication;
};

/// One sigma of a range at this distance.
inline double echo_sigma_m(double range_m, const TrackingConfig& config) {
  return config.sensor.range_noise_m + kRangeNoisePerM * range_m;
}

/// Speed above which a stopped object moves again; the gap to stopped_below_mps is a hysteresis.
inline double moving_above_mps(const TrackingConfig& config) {
  return 2.0 * config.motion.stopped_below_mps;
}

/// True where nothing larger than people moves: what no beam answered before may be a leg there.
/// On a road bushes, flat walls and the ground come and go in the same way:
/// docs/decisions/moving-object-detection.md.
inline bool only_people_move(const TrackingConfig& config) {
  return config.extent.longest_body_m < 3.0 * config.extent.size_scale;
}

}  // namespace slammot::tracking
