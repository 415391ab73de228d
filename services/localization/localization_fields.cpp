#include "services/localization/localization_fields.hpp"

#include <utility>

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::kNotNegative;
using config::kPositive;
using config::Range;
using config::with_nested;

FieldTable<grids::LastingModel> lasting_fields() {
  using C = grids::LastingModel;
  return {
      {"hit_log_odds",
       &C::hit_log_odds,
       "Added to what submaps keep where a stationary echo ended; from 0.6 on one echo is a wall.",
       Range{0.04, 7.8},
       {"Walls seen once are missing from the map.", "Single false echoes stay in the map."}},
      {"free_log_odds",
       &C::free_log_odds,
       "Taken off where a beam and those beside it passed, once a scan and cell.",
       Range{0.04, 7.8},
       {"What went away stays in the map.", "Thin posts vanish from the map."}},
  };
}

FieldTable<LocalMapConfig> map_fields() {
  using C = LocalMapConfig;
  FieldTable<C> fields = with_nested<C>(
      {
          {"side_m",
           &C::side_m,
           "Of the square held around the vehicle.",
           Range{10.0, 1000.0},
           {"Distant echoes find no map to match.", "Memory grows with the square."}},
          {"cell_size_m",
           &C::cell_size_m,
           "Of SO-map and MO-map.",
           Range{0.02, 1.0},
           {"Memory and time grow, and cells are seen too rarely.",
            "Doors close, and pedestrians beside walls are not seen to move."}},
          {"surfel_size_m",
           &C::surfel_size_m,
           "Of the cells whose echoes are averaged for matching.",
           Range{0.02, 2.0},
           {"Normals are noisy.", "Corners are rounded, poses less accurate."}},
          {"new_map_after_m",
           &C::new_map_after_m,
           "Distance from the map's centre at which a new map begins.",
           Range{1.0, 500.0},
           {"Many small submaps, each too poor to be recognised.",
            "Drift within a submap that no closure corrects."}},
          {"new_map_after_travel_m",
           &C::new_map_after_travel_m,
           "Distance travelled in a map after which a new one begins.",
           Range{1.0, 1e4},
           {"Many small submaps, each too poor to be recognised.",
            "Drift within a submap that no closure corrects."}},
          {"no_echo_free_m",
           &C::no_echo_free_m,
           "A beam without echo tells that this much is free.",
           Range{0.0, 200.0},
           {"Movers in open space are detected late.",
            "Dark bodies and glass are erased from the map."}},
          {"end_cell_tolerance_m",
           &C::end_cell_tolerance_m,
           "An occupied cell this near explains an echo.",
           Range{0.0, 5.0},
           {"Walls seem to move where the pose is a little off.",
            "Pedestrians beside walls are taken for the wall."}},
      },
      "lasting", &C::lasting, lasting_fields());
  return in_group(Group::map, std::move(fields));
}

FieldTable<sensing::MotionModelConfig> motion_fields() {
  using C = sensing::MotionModelConfig;
  return {
      {"position_noise_m",
       &C::position_noise_m,
       "One sigma of a step by wheels, of any length.",
       kPositive,
       {"Scans cannot correct wheels that jitter.", "Wheels hardly help where scans say little."}},
      {"position_noise_per_m",
       &C::position_noise_per_m,
       "What each metre of the step adds to it.",
       kNotNegative,
       {"Slip is believed.", "Corridors are shortened or stretched."}},
      {"sideways_noise_per_m",
       &C::sideways_noise_per_m,
       "And to that across it.",
       kNotNegative,
       {"A robot that skids is believed not to.",
        "Wheels do not hold a road vehicle in its lane where scans say little."}},
      {"heading_noise_rad",
       &C::heading_noise_rad,
       "One sigma of the heading of any step by wheels.",
       kPositive,
       {"Scans cannot correct the heading.", "The heading wanders where scans say little."}},
      {"heading_noise_per_m",
       &C::heading_noise_per_m,
       "What each metre of the step adds to it [rad/m].",
       kNotNegative,
       {"Scans cannot correct the heading on straight ways.",
        "The heading wanders where scans say little."}},
      {"heading_noise_per_rad",
       &C::heading_noise_per_rad,
       "What each radian turned adds to it.",
       kNotNegative,
       {"Wheels that slip in turns are believed.", "Turns in the open are lost."}},
      {"askew_prior_rad",
       &C::askew_prior_rad,
       "One sigma of the direction of the wheels' way, against the base's x axis: a scanner may be "
       "mounted askew.",
       kNotNegative,
       {"The map bends where the scanner is mounted askew.",
        "What slides in turns is mistaken for the mounting."}},
      {"scale_prior",
       &C::scale_prior,
       "One sigma of the factor on wheel distance, about 1.",
       kNotNegative,
       {"A wrong wheel radius stretches the map along the way.", "The factor follows noise."}},
      {"pivot_prior_m",
       &C::pivot_prior_m,
       "One sigma of the place about which the vehicle turns, ahead and to the left.",
       kNotNegative,
       {"A scanner far from the axle seems to slide in turns.",
        "Turns tell nothing of the position."}},
      {"stamp_offset_prior_s",
       &C::stamp_offset_prior_s,
       "One sigma of how much later the odometry is stamped than the scans; 0: not at all.",
       kNotNegative,
       {"In turns late wheels bend the map.", "The offset follows noise."}},
      {"speed_prior_mps",
       &C::speed_prior_mps,
       "Without odometry: one sigma of the speed at the start.",
       kPositive,
       {"A drive that begins at speed is lost.", "The first match may end on another wall."}},
      {"speed_walk_mps",
       &C::speed_walk_mps,
       "Without odometry: how the speed wanders [m/s per sqrt(s)].",
       kPositive,
       {"Braking is not followed.", "Corridors are shortened."}},
      {"pivot_walk_m",
       &C::pivot_walk_m,
       "Without odometry: how far from the base the vehicle may turn about, for a second at a "
       "time.",
       kNotNegative,
       {"Turns about another point are not followed.", "Turns tell nothing of the position."}},
  };
}

FieldTable<sensing::OdometryBeliefConfig> belief_fields() {
  using C = sensing::OdometryBeliefConfig;
  return {{"way_at_start",
           &C::way_at_start,
           "Way by scans over way by odometry, as far as it is known beforehand. Set by the log "
           "where it is far from 1.",
           kPositive,
           {"The map begins shortened, until the factor is learned.", "It begins stretched."}}};
}

FieldTable<matching::PointToLineConfig> match_fields() {
  using C = matching::PointToLineConfig;
  return in_group<C>(
      Group::matching,
      {
          {"coarse_gate_m",
           &C::coarse_gate_m,
           "Points farther than this from the nearest surfel do not count at first.",
           Range{0.01, 10.0},
           {"A prediction that is off is not corrected.", "Points match other walls."}},
          {"fine_gate_m",
           &C::fine_gate_m,
           "Points farther than this from the nearest surfel do not count in the end.",
           Range{0.01, 10.0},
           {"Matches lose good points.", "Points beyond the end of a wall pull the pose back."}},
          {"proven_after_m",
           &C::proven_after_m,
           "A surfel counts in full once it was seen from places this far apart.",
           kNotNegative,
           {"What a pitching vehicle sees of the ground counts as a wall.",
            "New walls count too little."}},
          {"robust_scale_m",
           &C::robust_scale_m,
           "Residual at which a point's weight has fallen to a quarter.",
           kPositive,
           {"Good points of rough walls lose their weight.", "Movers and bushes pull the pose."}},
          {"information_share",
           &C::information_share,
           "Points of one scan share the map's error: they count for this share.",
           Range{1e-6, 1.0},
           {"The pose follows the wheels.",
            "The pose follows each scan's errors, and wheels do not help."}},
      });
}

FieldTable<sensing::PoseErrors> pose_error_fields() {
  using C = sensing::PoseErrors;
  using A = sensing::AxisError;
  constexpr config::Consequences kSigma{"Published covariances are too small.",
                                        "Published covariances are too large."};
  const FieldTable<A> axis{
      {"of_scan", &A::of_scan,
       "Of published variances: share of the filter's by which each scan is off.", kPositive,
       kSigma},
      {"of_surprises", &A::of_surprises,
       "Share by which another part of the map is off, times what innovations of matches say.",
       kNotNegative, kSigma},
      {"of_map", &A::of_map, "Share by which another part of the map is off besides.", kNotNegative,
       kSigma},
      {"view_m",
       &A::view_m,
       "After this way half of what tells of the axis is another part of the map.",
       kPositive,
       {"Covariances over a short way are too large.",
        "Covariances over a short way are too small."}},
  };
  FieldTable<C> fields = with_nested<C>({}, "forward", &C::forward, axis);
  fields = with_nested<C>(std::move(fields), "sideways", &C::sideways, axis);
  return in_group(Group::publication,
                  with_nested<C>(std::move(fields), "heading", &C::heading, axis));
}

FieldTable<LocalizerConfig> sensor_fields() {
  using C = LocalizerConfig;
  return {
      {"match_range_m",
       &C::match_range_m,
       "Echoes beyond it are not matched.",
       kPositive,
       {"Open places leave too few echoes to match.",
        "Distant echoes with systematic errors pull the pose."}},
      {"min_range_m",
       &C::min_range_m,
       "Nearer echoes come from the vehicle itself.",
       kNotNegative,
       {"The vehicle maps its own body.", "What is near is not seen."}},
      {"range_noise_m",
       &C::range_noise_m,
       "One sigma of a range, for the match.",
       kPositive,
       {"The pose follows noise.", "Wheels outweigh the scans."}},
      {"sweep_factor_sigma",
       &C::sweep_factor_sigma,
       "One sigma of the factor on how long scanners' sweeps are said to take; 0: they are right.",
       kNotNegative,
       {"A sweep that runs the other way bends the map in turns.", "The factor follows noise."}},
  };
}

FieldTable<LocalizerConfig> odometry_fields() {
  using C = LocalizerConfig;
  return {
      {"use_odometry", &C::use_odometry,
       "Off, for wheels that are worse than none: constant velocity predicts."},
      {"fastest_mps",
       &C::fastest_mps,
       "Odometry that says more has jumped.",
       kPositive,
       {"Fast driving is taken for a jump.", "Jumps are believed."}},
      {"longest_step_s",
       &C::longest_step_s,
       "Without odometry nothing is extrapolated farther; longer gaps are counted.",
       kPositive,
       {"The vehicle seems to stop in a gap between scans.",
        "A wrong velocity carries it far in a gap."}},
      {"may_be_picked_up", &C::may_be_picked_up,
       "And set down elsewhere, with wheels that notice nothing; a road vehicle is not."},
      {"time_is_known", &C::time_is_known,
       "Off where stamps are made up: no speed means anything. Set by the log; a profile can only "
       "take it off."},
  };
}

FieldTable<LocalizerConfig> map_use_fields() {
  using C = LocalizerConfig;
  return {
      {"map_range_m",
       &C::map_range_m,
       "Echoes beyond it are not mapped.",
       kPositive,
       {"Distant walls are missing, and the heading drifts.", "Distant echoes smear the map."}},
      {"leave_out_moving", &C::leave_out_moving,
       "Off, to see what it is worth: everything is mapped and matched as if it stood."},
  };
}

FieldTable<LocalizerConfig> matching_fields() {
  using C = LocalizerConfig;
  return {
      {"body_sigma_without_wheels_m",
       &C::body_sigma_without_wheels_m,
       "Without odometry: one sigma of an error that all points of one body share; 0: none.",
       kNotNegative,
       {"One large mover carries the pose along.",
        "One wall beside the vehicle counts for little."}},
      {"lost_after_s",
       &C::lost_after_s,
       "Wheels are trusted for so long where scans do not match; then the pose is searched for.",
       kNotNegative,
       {"Traffic around the vehicle makes it search for itself.",
        "Poses are wrong for as long after the vehicle was set down elsewhere."}},
  };
}

FieldTable<LocalizerConfig> closing_fields() {
  using C = LocalizerConfig;
  return {
      {"drift_m_per_sqrt_m",
       &C::drift_m_per_sqrt_m,
       "One sigma of the position that matching adds along the way, for the graph and the search "
       "for revisits.",
       kPositive,
       {"Revisits are looked for too near, and closures are refused.",
        "Searches take long, and look-alikes are found."}},
      {"drift_rad_per_sqrt_m",
       &C::drift_rad_per_sqrt_m,
       "The same for the heading.",
       kPositive,
       {"Revisits are looked for too near, and closures are refused.",
        "Searches take long, and look-alikes are found."}},
      {"astray_sigma_m",
       &C::astray_sigma_m,
       "One sigma of the tie between two maps where the vehicle lost its way.",
       Range{1.0, 900.0},
       {"The place where it was set down lies outside of the search.", "Searches take long."}},
  };
}

FieldTable<LocalizerConfig> publication_fields() {
  using C = LocalizerConfig;
  return {
      {"expects_all_ranges", &C::expects_all_ranges,
       "Tells of every beam how far the map would let it go: for a detection of your own; ours "
       "asks only near echoes that contradict the map."},
      {"variance_by_scans_alone",
       &C::variance_by_scans_alone,
       "Without wheels, published variances over those within the local map.",
       kPositive,
       {"Published covariances are too small.", "Published covariances are too large."}},
  };
}

/// Members of the struct itself, group by group.
FieldTable<LocalizerConfig> own_fields() {
  using C = LocalizerConfig;
  return config::joined<C>(
      {in_group<C>(Group::sensor, sensor_fields()), in_group<C>(Group::odometry, odometry_fields()),
       in_group<C>(Group::map, map_use_fields()), in_group<C>(Group::matching, matching_fields()),
       in_group<C>(Group::closing, closing_fields()),
       in_group<C>(Group::publication, publication_fields())});
}

}  // namespace

const FieldTable<LocalizerConfig>& localization_fields() {
  using C = LocalizerConfig;
  static const FieldTable<C> table = [] {
    FieldTable<C> fields = with_nested<C>(own_fields(), "map", &C::map, map_fields());
    fields = with_nested<C>(std::move(fields), "belief", &C::belief,
                            in_group(Group::odometry, belief_fields()));
    fields = with_nested<C>(std::move(fields), "motion", &C::motion,
                            in_group(Group::odometry, motion_fields()));
    fields = with_nested<C>(std::move(fields), "match", &C::match, match_fields());
    return with_nested<C>(std::move(fields), "pose_errors", &C::pose_errors, pose_error_fields());
  }();
  return table;
}

}  // namespace slammot::localization
