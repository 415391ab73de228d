#include "services/localization/localization_fields.hpp"

#include <utility>

namespace slammot::localization {
namespace {

using config::FieldTable;
using config::kNotNegative;
using config::kPositive;
using config::kShare;
using config::Range;
using config::with_nested;

FieldTable<grids::EvidenceModel> evidence_fields() {
  using C = grids::EvidenceModel;
  return {
      {"hit_log_odds", &C::hit_log_odds, "Added where a stationary echo ended.", Range{0.01, 7.9}},
      {"free_log_odds", &C::free_log_odds, "Taken off where a beam passed, once a scan and cell.", Range{0.01, 7.9}},
      {"limit_log_odds", &C::limit_log_odds, "No cell is surer than this, so that the world may change.", Range{0.1, 7.9}},
      {"occupied_log_odds", &C::occupied_log_odds, "From here on a cell counts as occupied.", Range{0.01, 7.9}},
      {"moving_gain", &C::moving_gain, "Share of the missing evidence that one moving echo adds to the MO-map.", kShare},
  };
}

FieldTable<grids::LastingModel> lasting_fields() {
  using C = grids::LastingModel;
  return {
      {"hit_log_odds", &C::hit_log_odds, "Added to what submaps keep where a stationary echo ended; from 0.6 on one echo is a wall.", Range{0.04, 7.8}},
      {"free_log_odds", &C::free_log_odds, "Taken off where a beam and those beside it passed, once a scan and cell.", Range{0.04, 7.8}},
      {"limit_log_odds", &C::limit_log_odds, "No cell is surer than this, but for those that were driven over.", Range{0.1, 7.8}},
  };
}

FieldTable<LocalMapConfig> map_fields() {
  using C = LocalMapConfig;
  FieldTable<C> fields = with_nested<C>(
      {
          {"side_m", &C::side_m, "Of the square held around the vehicle.", Range{10.0, 1000.0}},
          {"cell_size_m", &C::cell_size_m, "Of SO-map and MO-map.", Range{0.02, 1.0}},
          {"surfel_size_m", &C::surfel_size_m, "Of the cells whose echoes are averaged for matching.", Range{0.02, 2.0}},
          {"surfel_weight_limit", &C::surfel_weight_limit, "Echoes after which a surfel's mean becomes a running one.",
           Range{1.0, 1e6}},
          {"new_map_after_m", &C::new_map_after_m, "Distance from the map's centre at which a new map begins.",
           Range{1.0, 500.0}},
          {"new_map_after_travel_m", &C::new_map_after_travel_m, "Distance travelled in a map after which a new one begins.",
           Range{1.0, 1e4}},
          {"no_echo_free_m", &C::no_echo_free_m, "A beam without echo tells that this much is free.", Range{0.0, 200.0}},
          {"free_log_odds", &C::free_log_odds, "With this much against it a cell counts as free.", Range{0.01, 7.9}},
          {"end_cell_tolerance_m", &C::end_cell_tolerance_m, "An occupied cell this near explains an echo.", Range{0.0, 5.0}},
      },
      "evidence", &C::evidence, evidence_fields());
  return with_nested<C>(std::move(fields), "lasting", &C::lasting, lasting_fields());
}

FieldTable<sensing::MotionModelConfig> motion_fields() {
  using C = sensing::MotionModelConfig;
  return {
      {"position_noise_m", &C::position_noise_m, "One sigma of a step of any length.", kPositive},
      {"position_noise_per_m", &C::position_noise_per_m, "What each metre of the step adds to it.", kNotNegative},
      {"sideways_noise_per_m", &C::sideways_noise_per_m, "And to that across it.", kNotNegative},
      {"heading_noise_rad", &C::heading_noise_rad, "One sigma of the heading of any step.", kPositive},
      {"heading_noise_per_m", &C::heading_noise_per_m, "What each metre of the step adds to it [rad/m].", kNotNegative},
      {"heading_noise_per_rad", &C::heading_noise_per_rad, "What each radian turned adds to it.", kNotNegative},
      {"standing_noise_m_per_sqrt_s", &C::standing_noise_m_per_sqrt_s, "How far it may slide in a second where wheels have stood for a while: one sigma, growing with the root of time.", kPositive},
      {"standing_noise_rad_per_sqrt_s", &C::standing_noise_rad_per_sqrt_s, "And how far turn.", kPositive},
      {"askew_prior_rad", &C::askew_prior_rad, "One sigma of the direction of the wheels' way, against the base's x axis: a scanner may be mounted askew.", kNotNegative},
      {"scale_prior", &C::scale_prior, "One sigma of the factor on wheel distance, about 1.", kNotNegative},
      {"heading_rate_bias_prior_radps", &C::heading_rate_bias_prior_radps, "One sigma of the gyro's bias.", kNotNegative},
      {"heading_per_metre_bias_prior", &C::heading_per_metre_bias_prior, "One sigma of what unequal wheels turn [rad/m].",
       kNotNegative},
      {"pivot_prior_m", &C::pivot_prior_m, "One sigma of the place about which the vehicle turns, ahead and to the left.", kNotNegative},
      {"stamp_offset_prior_s", &C::stamp_offset_prior_s, "One sigma of how much later the odometry is stamped than the scans; 0: not at all.", kNotNegative},
      {"scale_walk_per_sqrt_m", &C::scale_walk_per_sqrt_m, "How the scale wanders with the distance, one sigma.", kNotNegative},
      {"heading_rate_bias_walk", &C::heading_rate_bias_walk, "How the gyro's bias wanders with time [rad/s per sqrt(s)].", kNotNegative},
      {"stamp_offset_walk", &C::stamp_offset_walk, "How that offset wanders with time [s per sqrt(s)].", kNotNegative},
      {"speed_prior_mps", &C::speed_prior_mps, "Without odometry: one sigma of the speed at the start.", kPositive},
      {"yaw_rate_prior_radps", &C::yaw_rate_prior_radps, "Without odometry: one sigma of the turn rate at the start.", kPositive},
      {"speed_walk_mps", &C::speed_walk_mps, "Without odometry: how the speed wanders [m/s per sqrt(s)].", kPositive},
      {"pivot_walk_m", &C::pivot_walk_m, "Without odometry: how far from the base the vehicle may turn about, for a second at a time.", kNotNegative},
      {"yaw_rate_walk_radps", &C::yaw_rate_walk_radps, "Without odometry: how the turn rate wanders [rad/s per sqrt(s)].", kPositive},
  };
}

FieldTable<WheelJumpConfig> wheel_jump_fields() {
  using C = WheelJumpConfig;
  return {
      {"acceleration_mps2", &C::acceleration_mps2, "A vehicle that changes its speed faster has not: its odometry has jumped.", kPositive},
      {"turn_acceleration_radps2", &C::turn_acceleration_radps2, "The same for how it turns.", kPositive},
      {"jitter_m", &C::jitter_m, "What wheels may say beyond that in a step, read at another time than the scan.", kNotNegative},
      {"jitter_rad", &C::jitter_rad, "The same for the heading.", kNotNegative},
  };
}

FieldTable<sensing::OdometryBeliefConfig> belief_fields() {
  using C = sensing::OdometryBeliefConfig;
  return {
      {"enabled", &C::enabled, "Weighs several explanations of odometry by the scans; off: odometry is right, or has jumped."},
      {"switch_per_scan", &C::switch_per_scan, "Probability that the explanation changes from one scan to the next.", kShare},
      {"rough_prior", &C::rough_prior, "After a change: share of wheels with far more noise.", kShare},
      {"recalibrated_prior", &C::recalibrated_prior, "Share of wheels with other factors.", kShare},
      {"other_prior", &C::other_prior, "Share of wheels that say nothing.", kShare},
      {"rough_sigmas", &C::rough_sigmas, "Noise of rough wheels, times the usual one.", kPositive},
      {"suspicious_below", &C::suspicious_below, "Below this probability of odometry being right every explanation is matched for itself.", kShare},
      {"suspicious_share_drop", &C::suspicious_share_drop, "So is it where the matched share falls below its usual value by more than this.", kShare},
      {"share_nats", &C::share_nats, "Log-likelihood of all points matched against none, if points erred independently.", kPositive},
      {"usual_step_memory", &C::usual_step_memory, "Weight of one step in the usual time between scans.", kShare},
      {"usual_share_memory", &C::usual_share_memory, "Weight of one scan in the usual matched share.", kShare},
      {"reach_m", &C::reach_m, "Wheels that say nothing, without time: one sigma of the position.", kPositive},
      {"reach_per_m", &C::reach_per_m, "What each metre by odometry adds to it.", kNotNegative},
      {"usual_reach", &C::usual_reach, "Without odometry, what the usual step adds, as a share of it.", kNotNegative},
      {"repeat_share", &C::repeat_share, "One sigma of a step that is like one before, as a share of it.", kNotNegative},
      {"repeat_m", &C::repeat_m, "What is added to it.", kPositive},
      {"repeat_rad", &C::repeat_rad, "One sigma of its turn.", kPositive},
      {"way_at_start", &C::way_at_start, "Way by scans over way by odometry, as far as it is known beforehand. Set by the log where it is far from 1.", kPositive},
      {"reach_rad", &C::reach_rad, "One sigma of the heading.", kPositive},
      {"reach_per_rad", &C::reach_per_rad, "What each radian by odometry adds to it.", kNotNegative},
  };
}

FieldTable<matching::PointToLineConfig> match_fields() {
  using C = matching::PointToLineConfig;
  return {
      {"coarse_steps", &C::coarse_steps, "Gauss-Newton steps with the wide gate.", Range{0, 100}},
      {"fine_steps", &C::fine_steps, "Gauss-Newton steps with the narrow gate.", Range{0, 100}},
      {"coarse_gate_m", &C::coarse_gate_m, "Points farther than this from the nearest surfel do not count at first.",
       Range{0.01, 10.0}},
      {"fine_gate_m", &C::fine_gate_m, "Points farther than this from the nearest surfel do not count in the end.",
       Range{0.01, 10.0}},
      {"proven_after_m", &C::proven_after_m, "A surfel counts in full once it was seen from places this far apart.", kNotNegative},
      {"unproven_share", &C::unproven_share, "Before, it counts for this share.", kShare},
      {"new_below_m", &C::new_below_m, "A surfel first seen less than this much of way ago is new: only what the pose tells of the wheels depends on it.", kPositive},
      {"robust_scale_m", &C::robust_scale_m, "Residual at which a point's weight has fallen to a quarter.", kPositive},
      {"coarse_prior_sigmas", &C::coarse_prior_sigmas, "With the wide gate, what so many sigmas of the prediction put off the surface widens that; without any wheels always 2.", kNotNegative},
      {"information_share", &C::information_share, "Points of one scan share the map's error: they count for this share.",
       Range{1e-6, 1.0}},
      {"body_sigma_m", &C::body_sigma_m, "One sigma of an error that all points of one body share; 0: none.", kNotNegative},
      {"body_length_m", &C::body_length_m, "A run of neighbouring points this long may be one body.", kPositive},
      {"converged_m", &C::converged_m, "A step shorter than this is the last.", kNotNegative},
  };
}

FieldTable<matching::CorrelativeConfig> search_fields() {
  using C = matching::CorrelativeConfig;
  return {
      {"resolution_m", &C::resolution_m, "Cell of the finest grid and step of the search.", Range{0.01, 2.0}},
      {"smear_sigma_m", &C::smear_sigma_m, "Of the Gaussian around every target point.", kPositive},
      {"heading_step_rad", &C::heading_step_rad, "0: the step that moves the far points by one cell.", Range{0.0, 1.0}},
      {"min_score", &C::min_score, "Peaks below it are not looked for.", kShare},
      {"max_peaks", &C::max_peaks, "Poses that are looked for.", Range{1, 100}},
      {"min_peak_ratio", &C::min_peak_ratio, "Further peaks score at least this share of the best one.", kShare},
      {"peak_separation_m", &C::peak_separation_m, "Further peaks differ by more than this in x or y.", kNotNegative},
      {"peak_separation_rad", &C::peak_separation_rad, "Further peaks may differ by more than this in heading instead.",
       kNotNegative},
      {"independent_points", &C::independent_points, "Points that err independently; scales the covariance.", kPositive},
  };
}

FieldTable<sensing::PoseErrors> pose_error_fields() {
  using C = sensing::PoseErrors;
  using A = sensing::AxisError;
  const FieldTable<A> axis{
      {"of_scan", &A::of_scan, "Of published variances: share of the filter's by which each scan is off.", kPositive},
      {"of_surprises", &A::of_surprises, "Share by which another part of the map is off, times what surprises of matches say.", kNotNegative},
      {"of_map", &A::of_map, "Share by which another part of the map is off besides.", kNotNegative},
      {"view_m", &A::view_m, "After this way half of what tells of the axis is another part of the map.", kPositive},
  };
  FieldTable<C> fields = with_nested<C>({}, "forward", &C::forward, axis);
  fields = with_nested<C>(std::move(fields), "sideways", &C::sideways, axis);
  return with_nested<C>(std::move(fields), "heading", &C::heading, axis);
}

FieldTable<AmbiguousMatchConfig> ambiguous_fields() {
  using C = AmbiguousMatchConfig;
  using S = matching::ScrimConfig;
  return with_nested<C>(
      {
          {"weak_share", &C::weak_share, "A scan that says less than this share of the most about some direction is sampled; 0: none is.", kShare},
          {"along_sigma_m", &C::along_sigma_m, "What the spread of guesses adds to that of the prediction along that direction.", kNotNegative},
          {"across_sigma_m", &C::across_sigma_m, "The same across it.", kNotNegative},
          {"heading_sigma_rad", &C::heading_sigma_rad, "The same in heading.", kNotNegative},
          {"least_narrowing", &C::least_narrowing, "Where sampling narrows the variance of the guesses by less than this share nothing is observed.", kShare},
      },
      "scrim", &C::scrim,
      FieldTable<S>{
          {"samples", &S::samples, "Initial guesses; an odd number is one less.", Range{8, 10000}},
          {"cell_size_m", &S::cell_size_m, "Of the grids that are correlated.", Range{0.01, 2.0}},
          {"least_share", &S::least_share, "Samples with less than this share of the best correlation do not count.", kShare},
          {"valley_share", &S::valley_share, "Two neighbours are of different clusters where the correlation between them is below this share of both.", kShare},
      });
}

FieldTable<LocalizerConfig> own_fields() {
  using C = LocalizerConfig;
  return {
      {"match_range_m", &C::match_range_m, "Echoes beyond it are not matched.", kPositive},
      {"map_range_m", &C::map_range_m, "Echoes beyond it are not mapped.", kPositive},
      {"min_range_m", &C::min_range_m, "Nearer echoes come from the vehicle itself.", kNotNegative},
      {"range_noise_m", &C::range_noise_m, "One sigma at the scanner.", kPositive},
      {"range_noise_per_m", &C::range_noise_per_m, "What each metre of range adds to it.", kNotNegative},
      {"min_echoes", &C::min_echoes, "With fewer, the prediction is the pose.", Range{1, 4096}},
      {"least_matched_share", &C::least_matched_share, "With fewer points matched, the match is not believed.", kShare},
      {"search_when_sigma_m", &C::search_when_sigma_m, "A prediction less sure than this is searched for by correlation.",
       kPositive},
      {"search_when_heading_sigma_rad", &C::search_when_heading_sigma_rad, "So is one less sure of its heading than this.",
       kPositive},
      {"search_reach_m", &C::search_reach_m, "Half side of the square of the map that is searched.", Range{1.0, 200.0}},
      {"search_sigmas", &C::search_sigmas, "Half width of the search window in standard deviations of the prediction.",
       Range{0.1, 20.0}},
      {"most_contradicted_share", &C::most_contradicted_share, "Lost, too, where the prediction is vague and more of the points lie in what the map knows to be free.", kShare},
      {"most_contradicted_when_sure", &C::most_contradicted_when_sure, "Lost, too, where it is sure and so many of them do: traffic alone does not.", kShare},
      {"found_share", &C::found_share, "Lost, it has found itself again where so many points match.", kShare},
      {"found_scans", &C::found_scans, "And so many scans in a row, before they go into the map again.", Range{0, 1000}},
      {"recovers", &C::recovers, "Looks for itself after being carried away; off: goes on by dead reckoning."},
      {"lost_after_s", &C::lost_after_s, "Wheels are trusted for so long where scans do not match; then it looks for itself.", kNotNegative},
      {"astray_after_s", &C::astray_after_s, "After so long in vain a new map begins, tied to the last one by next to nothing.", kPositive},
      {"astray_sigma_m", &C::astray_sigma_m, "One sigma of that tie.", Range{1.0, 900.0}},
      {"expects_all_ranges", &C::expects_all_ranges, "Tells of every beam how far the map would let it go: for a detection of your own; ours asks only near echoes that contradict the map."},
      {"leave_out_moving", &C::leave_out_moving, "Off, to see what it is worth: everything is mapped and matched as if it stood."},
      {"may_be_picked_up", &C::may_be_picked_up, "And set down elsewhere, with wheels that notice nothing; a road vehicle is not."},
      {"sweep_factor_sigma", &C::sweep_factor_sigma, "One sigma of the factor on how long scanners' sweeps are said to take; 0: they are right.", kNotNegative},
      {"body_sigma_without_wheels_m", &C::body_sigma_without_wheels_m, "match.body_sigma_m where no wheels say how far it is.", kNotNegative},
      {"time_is_known", &C::time_is_known, "Off where stamps are made up: no speed means anything. Set by the log; a profile can only take it off."},
      {"use_odometry", &C::use_odometry, "Off, for wheels that are worse than none: constant velocity predicts."},
      {"mask_margin_m", &C::mask_margin_m, "Around a tracked object's box, left out of the match.", kNotNegative},
      {"longest_step_s", &C::longest_step_s, "Without odometry nothing is extrapolated farther; longer gaps are counted.", kPositive},
      {"far_ahead_s", &C::far_ahead_s, "A stamp so far ahead of those before is believed when a second one agrees.", Range{1.0, 1e6}},
      {"fastest_mps", &C::fastest_mps, "Odometry that says more has jumped.", kPositive},
      {"max_pending", &C::max_pending, "Scans that wait for labels before the map goes on without.", Range{1, 100}},
      {"longest_label_wait_s", &C::longest_label_wait_s, "Nor does it wait longer than this, by the scans' stamps.", Range{0.0, 10.0}},
      {"variance_memory_s", &C::variance_memory_s, "Over which published covariances are fitted to the surprises seen.", kPositive},
      {"variance_by_scans_alone", &C::variance_by_scans_alone, "Without wheels, published variances over those within the local map.", kPositive},
      {"compared_over_s", &C::compared_over_s, "Published covariances are to be honest about the motion over this time.", kPositive},
      {"drift_m_per_sqrt_m", &C::drift_m_per_sqrt_m, "One sigma that dead reckoning by matching adds to constraints.",
       kPositive},
      {"drift_rad_per_sqrt_m", &C::drift_rad_per_sqrt_m, "The same for their heading.", kPositive},
  };
}

}  // namespace

const FieldTable<LocalizerConfig>& localization_fields() {
  using C = LocalizerConfig;
  static const FieldTable<C> table = [] {
    FieldTable<C> fields = with_nested<C>(own_fields(), "map", &C::map, map_fields());
    fields = with_nested<C>(std::move(fields), "wheel_jump", &C::wheel_jump, wheel_jump_fields());
    fields = with_nested<C>(std::move(fields), "belief", &C::belief, belief_fields());
    fields = with_nested<C>(std::move(fields), "search", &C::search, search_fields());
    fields = with_nested<C>(std::move(fields), "motion", &C::motion, motion_fields());
    fields = with_nested<C>(std::move(fields), "match", &C::match, match_fields());
    fields = with_nested<C>(std::move(fields), "ambiguous", &C::ambiguous, ambiguous_fields());
    return with_nested<C>(std::move(fields), "pose_errors", &C::pose_errors, pose_error_fields());
  }();
  return table;
}

}  // namespace slammot::localization
