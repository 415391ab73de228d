#include "services/tracking/tracking_fields.hpp"

#include <utility>

#include "common/config/physical_ranges.hpp"

namespace slammot::tracking {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::kLength_m;
using config::kLengthOrZero_m;
using config::kNotNegative;
using config::kPositive;
using config::kSpeed_mps;
using config::kSpeedOrZero_mps;
using config::Range;
using config::with_members_of;

FieldTable<SensorNoise> sensor_fields() {
  using C = SensorNoise;
  return {
      {"range_noise_m",
       &C::range_noise_m,
       "One sigma of a range at the scanner.",
       kLength_m,
       {"Tracks follow noise, and lose echoes.",
        "Velocities lag, and published errors are large."}},
      {"shape_noise_m",
       &C::shape_noise_m,
       "One sigma of the distance of an edge from its box.",
       kLength_m,
       {"Bumpers and mirrors pull the box.", "Velocities of vehicles converge late."}},
  };
}

FieldTable<MotionConfig> motion_fields() {
  using C = MotionConfig;
  return {
      {"velocity_noise_density",
       &C::velocity_noise_density,
       "Process noise of constant velocity, as white acceleration [m^2/s^3].",
       kPositive,
       {"Gentle changes of speed are followed late.", "Velocities of cruising objects are noisy."}},
      {"mixture", &C::mixture,
       "Which histories of modes are merged: IMM; GPB1, as cheap and worse in manoeuvres; GPB2, as "
       "good for twice the filters."},
      {"move_stop", &C::move_stop,
       "Holds a stop hypothesis against the modes: standing objects have no velocity."},
      {"coordinated_turn", &C::coordinated_turn,
       "Adds the coordinated turn as a third mode of vehicles that surely move. For slow "
       "scanners."},
      {"formations", &C::formations,
       "Tracks a queue of vehicles as one state: hidden ones brake with the others."},
      {"fastest_mps",
       &C::fastest_mps,
       "Speed of the fastest objects: twice the sigma of a new track's speed.",
       kSpeed_mps,
       {"Fast objects are lost before they are confirmed.",
        "New tracks jump to neighbours, and velocities converge late."}},
      {"stopped_below_mps",
       &C::stopped_below_mps,
       "Below this speed an object stops; above twice this speed it moves again.",
       kSpeedOrZero_mps,
       {"Standing objects are published as moving.",
        "Creeping vehicles are published as standing."}},
  };
}

FieldTable<AssociationConfig> association_fields() {
  using C = AssociationConfig;
  return {
      {"gate_margin_m",
       &C::gate_margin_m,
       "Points this near to a predicted body belong to it.",
       kLengthOrZero_m,
       {"Parts of one body become tracks of their own.",
        "Bodies take echoes of their neighbours."}},
      {"widest_gate_m",
       &C::widest_gate_m,
       "Largest distance of an echo from a predicted body, however uncertain the prediction is.",
       kLength_m,
       {"Objects that emerge from behind others get new identities.",
        "Tracks jump to other objects."}},
      {"most_hypotheses",
       &C::most_hypotheses,
       "Hypotheses of the association of pedestrians who walk close together; 1: nearest "
       "neighbour.",
       Range{1, 64},
       {"Pedestrians who meet may exchange identities.", "Time grows with their number."}},
  };
}

FieldTable<ExtentConfig> extent_fields() {
  using C = ExtentConfig;
  return {
      {"size_scale",
       &C::size_scale,
       "Size of road users relative to real ones; 0.1 for models at 1:10.",
       kPositive,
       {"Vehicles are taken for several, or for none.", "Neighbours join, classes are wrong."}},
      {"longest_body_m",
       &C::longest_body_m,
       "Longer segments are not objects. Below 3 m times the scale only people move, and the "
       "evidence of legs counts.",
       kLength_m,
       {"Trucks and buses are not tracked.", "Walls become tracks."}},
      {"box_from_extent_m",
       &C::box_from_extent_m,
       "Objects longer than this are boxes with a heading, smaller ones blobs.",
       kLengthOrZero_m,
       {"Pairs of pedestrians become boxes.", "Bicycles and small cars have no heading."}},
      {"box_from_speed_mps",
       &C::box_from_speed_mps,
       "Above this speed the heading of a box is that of its velocity.",
       kSpeedOrZero_mps,
       {"Standing boxes turn with noise.", "Headings of creeping vehicles stay wrong."}},
      {"stride_m",
       &C::stride_m,
       "Small segments this near to a pedestrian are one of the legs.",
       kLengthOrZero_m,
       {"Legs become pedestrians of their own.", "Pedestrians beside each other are one."}},
      {"merge_overlap_m",
       &C::merge_overlap_m,
       "Tracks whose bodies overlap this deep with like motion are one object.",
       kLengthOrZero_m,
       {"Neighbours merge.", "One vehicle has two tracks."}},
  };
}

/// Which scans speak for a track, and how much of them confirms it.
FieldTable<ExistenceConfig> confirmation_fields() {
  using C = ExistenceConfig;
  return {
      {"contradicted_above_mps",
       &C::contradicted_above_mps,
       "Above this speed echoes where something stood before speak against a track.",
       kSpeedOrZero_mps,
       {"Long flanks and crowds end tracks.", "Walls that seem to move remain tracks."}},
      {"least_travel_m",
       &C::least_travel_m,
       "Distance from its birth before a track is confirmed, unless most echoes say that it moved.",
       kLengthOrZero_m,
       {"Bushes and posts become objects.", "Objects are confirmed late."}},
  };
}

/// When a track refuses echoes, stands too long, or ends.
FieldTable<ExistenceConfig> termination_fields() {
  using C = ExistenceConfig;
  return {
      {"least_travel_to_stand_m",
       &C::least_travel_to_stand_m,
       "A confirmed track may stand 2 s for each time that it has come so far.",
       kLengthOrZero_m,
       {"False tracks on bushes last.", "Pedestrians who wait lose their track."}},
      {"least_surprise_m",
       &C::least_surprise_m,
       "Least distance at which echoes beyond six sigmas of a confirmed track's prediction are "
       "outliers.",
       kLengthOrZero_m,
       {"Sharp manoeuvres lose the track.", "Tracks jump to neighbours."}},
      {"longest_unseen_s",
       &C::longest_unseen_s,
       "A confirmed track without echoes ends after this time.",
       kPositive,
       {"Objects get new identities behind others.", "Predictions wander and take other objects."}},
  };
}

FieldTable<PublicationConfig> publication_fields() {
  using C = PublicationConfig;
  return {
      {"longest_unseen_published_s",
       &C::longest_unseen_published_s,
       "A confirmed track without echoes is published as occluded, with its predicted state, for "
       "this time.",
       kNotNegative,
       {"Objects behind others vanish.", "Predictions far from the objects are published."}},
      {"most_speed_sigma_published_mps",
       &C::most_speed_sigma_published_mps,
       "A track with a larger sigma of the velocity is not published as confirmed.",
       kSpeed_mps,
       {"Objects are published late.", "Wrong velocities are published."}},
  };
}

}  // namespace

const FieldTable<TrackingConfig>& tracking_fields() {
  using C = TrackingConfig;
  static const FieldTable<C> table = [] {
    FieldTable<C> fields =
        with_members_of<C>({}, &C::sensor, in_group(Group::sensor, sensor_fields()));
    fields =
        with_members_of<C>(std::move(fields), &C::motion, in_group(Group::motion, motion_fields()));
    fields = with_members_of<C>(std::move(fields), &C::association,
                                in_group(Group::association, association_fields()));
    fields =
        with_members_of<C>(std::move(fields), &C::extent, in_group(Group::extent, extent_fields()));
    fields = with_members_of<C>(
        std::move(fields), &C::existence,
        in_group(Group::existence,
                 config::joined<ExistenceConfig>({confirmation_fields(), termination_fields()})));
    return with_members_of<C>(std::move(fields), &C::publication,
                              in_group(Group::publication, publication_fields()));
  }();
  return table;
}

}  // namespace slammot::tracking
