#include "services/tracking/tracking_fields.hpp"

namespace slammot::tracking {

const config::FieldTable<TrackingConfig>& tracking_fields() {
  using C = TrackingConfig;
  using config::kNotNegative;
  using config::kPositive;
  using config::kShare;
  using config::Range;
  constexpr Range kScore{-1000.0, 1000.0};
  static const config::FieldTable<C> table = {
      {"velocity_noise_density", &C::velocity_noise_density, "Of white acceleration while cruising [m^2/s^3].", kPositive},
      {"jerk_noise_density", &C::jerk_noise_density, "While manoeuvring [m^2/s^5].", kPositive},
      {"idle_acceleration_mps2", &C::idle_acceleration_mps2, "One sigma of the acceleration that cruising leaves open.",
       kPositive},
      {"mean_stay_s", &C::mean_stay_s, "Mean time in one of the two.", kPositive},
      {"fastest_mps", &C::fastest_mps, "One sigma of a new track's speed is half of this.", kPositive},
      {"stopped_below_mps", &C::stopped_below_mps, "Slower for a while is stopped.", kNotNegative},
      {"moving_above_mps", &C::moving_above_mps, "Faster is moving again.", kNotNegative},
      {"range_noise_m", &C::range_noise_m, "One sigma at the scanner.", kPositive},
      {"range_noise_per_m", &C::range_noise_per_m, "What each metre of range adds to it.", kNotNegative},
      {"shape_noise_m", &C::shape_noise_m, "One sigma of how far an edge may lie off a box.", kPositive},
      {"blob_noise_share", &C::blob_noise_share, "Of its extent: how the middle of something without sides wanders.",
       kNotNegative},
      {"gait_noise_m", &C::gait_noise_m, "How far who walks may be off the middle of the legs.", kNotNegative},
      {"gate_share", &C::gate_share, "Of true pairs that the gate lets through.", Range{0.5, 0.999999}},
      {"gate_margin_m", &C::gate_margin_m, "Points this near a predicted body are its own.", kNotNegative},
      {"widest_gate_m", &C::widest_gate_m, "However unsure the prediction is.", kPositive},
      {"other_label_cost", &C::other_label_cost, "Added for a segment that detection does not hold to be moving.", kNotNegative},
      {"larger_body_cost_per_m", &C::larger_body_cost_per_m, "Added for each metre by which a segment outgrows the body.",
       kNotNegative},
      {"birth_score", &C::birth_score, "Log-odds of existence of a new track.", kScore},
      {"moving_hit_score", &C::moving_hit_score, "What a segment that moves adds, where the track should be.", kScore},
      {"other_hit_score", &C::other_hit_score, "What any other segment there adds.", kScore},
      {"contradiction_score", &C::contradiction_score, "What a segment adds that stands where something stood before.",
       kScore},
      {"contradicted_above_mps", &C::contradicted_above_mps, "What is faster does not lie on what stood there before.", kNotNegative},
      {"mapped_memory_s", &C::mapped_memory_s, "For which echoes from where the map has something count.", kPositive},
      {"most_mapped_share", &C::most_mapped_share, "With more of them what makes no way is what the map has.", kShare},
      {"mapped_score_per_s", &C::mapped_score_per_s, "While it does.", kScore},
      {"occluded_score_per_s", &C::occluded_score_per_s, "While something hides it.", kScore},
      {"out_of_view_score_per_s", &C::out_of_view_score_per_s, "While it is out of the scanner's view.", kScore},
      {"passed_beam_score", &C::passed_beam_score, "For each beam that went through where the body should be.", kScore},
      {"most_passed_score", &C::most_passed_score, "By such beams in one scan at most.", kScore},
      {"most_surprise_sigmas", &C::most_surprise_sigmas, "Echoes so far off a confirmed track's prediction are not its own, if also as far off as the next says.", kPositive},
      {"least_surprise_m", &C::least_surprise_m, "How far off they must be at least.", kNotNegative},
      {"surprise_score", &C::surprise_score, "What such echoes add.", kScore},
      {"implausible_score", &C::implausible_score, "What a shape or speed adds that nothing on the road has.", kScore},
      {"least_points_at_birth", &C::least_points_at_birth, "Of a segment that begins a track.", Range{1, 4096}},
      {"most_score", &C::most_score, "No track is surer than this.", kPositive},
      {"confirm_score", &C::confirm_score, "From here on a track may be confirmed.", kScore},
      {"reject_score", &C::reject_score, "Below this a track ends.", kScore},
      {"least_hits", &C::least_hits, "Segments before a track can be confirmed.", Range{1, 1000}},
      {"compare_after_s", &C::compare_after_s, "Between the scans that are compared to tell what moved.", kPositive},
      {"compare_fast_after_s", &C::compare_fast_after_s, "The same for what moves fast.", kPositive},
      {"compare_slow_after_s", &C::compare_slow_after_s, "The same for what moves slowly.", kPositive},
      {"evidence_memory_s", &C::evidence_memory_s, "For which echoes that tell of motion count.", kPositive},
      {"least_moved_votes", &C::least_moved_votes, "Echoes that must say that a track has moved, to be confirmed.", kNotNegative},
      {"least_moved_share", &C::least_moved_share, "Their share among those that also say that it stood.", kShare},
      {"sure_moved_votes", &C::sure_moved_votes, "With so many of them a track need not have come far, if the next holds, too.", kNotNegative},
      {"sure_moved_share", &C::sure_moved_share, "Their share for that.", kShare},
      {"least_travel_m", &C::least_travel_m, "From where it began, to be confirmed.", kNotNegative},
      {"least_travel_sigmas", &C::least_travel_sigmas, "The same in its own standard deviations.", kNotNegative},
      {"most_speed_sigma_mps", &C::most_speed_sigma_mps, "A velocity less well known than this is not confirmed.", kPositive},
      {"longest_unseen_s", &C::longest_unseen_s, "Without a segment before a track ends, however well it is explained.",
       kPositive},
      {"longest_unseen_published_s", &C::longest_unseen_published_s, "After which it is followed, but not published as confirmed.",
       kPositive},
      {"publish_score", &C::publish_score, "With a lower score it is not published as confirmed.", kScore},
      {"longest_unseen_tentative_s", &C::longest_unseen_tentative_s, "The same for one that is not confirmed.", kPositive},
      {"longest_tentative_s", &C::longest_tentative_s, "What has not proven to move by then is rejected.", kPositive},
      {"box_from_extent_m", &C::box_from_extent_m, "Larger objects have sides; smaller ones are blobs.", kNotNegative},
      {"box_from_speed_mps", &C::box_from_speed_mps, "Their heading is that of motion above this speed.", kNotNegative},
      {"size_scale", &C::size_scale, "Of all road users, against real ones.", kPositive},
      {"longest_body_m", &C::longest_body_m, "No object is longer.", kPositive},
      {"stride_m", &C::stride_m, "Small things so near to someone who walks are a leg.", kNotNegative},
      {"least_travel_to_stand_m", &C::least_travel_to_stand_m, "For each time that it has come so far a confirmed track may stand as long as the next says.", kNotNegative},
      {"longest_stand_s", &C::longest_stand_s, "After which it is held never to have moved.", kPositive},
      {"merge_overlap_m", &C::merge_overlap_m, "Bodies that reach this deep into each other with like motion are one.",
       kNotNegative},
  };
  return table;
}

}  // namespace slammot::tracking
