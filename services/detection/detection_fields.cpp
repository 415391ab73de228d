#include "services/detection/detection_fields.hpp"

namespace slammot::detection {
namespace {

using config::FieldTable;
using config::kNotNegative;
using config::kPositive;
using config::kShare;
using config::Range;

FieldTable<sensing::SegmentationConfig> segmentation_fields() {
  using C = sensing::SegmentationConfig;
  return {
      {"gap_m", &C::gap_m, "Echoes farther apart than this, at no distance, are of different things.", kNotNegative},
      {"gap_beam_spacings", &C::gap_beam_spacings, "What the distance between neighbouring beams there adds, times this.",
       kNotNegative},
      {"widest_gap_m", &C::widest_gap_m, "At no distance is a gap wider.", kPositive},
      {"bridged_beams", &C::bridged_beams, "Beams without echo that may lie between two echoes of one thing.", Range{0, 100}},
      {"line_gap_m", &C::line_gap_m, "A straight wall seen at a grazing angle goes on across so wide a gap.", kNotNegative},
      {"line_gap_growth", &C::line_gap_growth, "That gap is at most so many times the one before.", kPositive},
      {"line_tolerance_m", &C::line_tolerance_m, "The next echo lies this near to the wall's line.", kPositive},
      {"dark_gap_m", &C::dark_gap_m, "Echoes of something dark, one here and one there on a line, lie no farther apart.", kNotNegative},
      {"dark_gap_beams", &C::dark_gap_beams, "Beams without echo that may lie between two of them; 0: they are not joined.", Range{0, 100}},
  };
}

FieldTable<DetectionConfig> own_fields() {
  using C = DetectionConfig;
  return {
      {"moving_share", &C::moving_share, "A segment moves when more than this of its decidable points do.", kShare},
      {"least_free_log_odds", &C::least_free_log_odds, "An end cell less surely free than this says nothing.", kNotNegative},
      {"explained_within_m", &C::explained_within_m, "An echo this near to the expected outline contradicts nothing.",
       kNotNegative},
      {"explained_within_per_m", &C::explained_within_per_m, "What each metre of range adds to that.", kNotNegative},
      {"least_moving_evidence", &C::least_moving_evidence, "MO-map evidence that decides where the SO-map cannot.", kShare},
      {"largest_by_moving_evidence", &C::largest_by_moving_evidence, "Points of a segment that may move by the MO-map alone.",
       Range{0, 4096}},
      {"least_moving_run", &C::least_moving_run, "Moving beams side by side that make a segment of their own.", Range{1, 4096}},
      {"least_stationary_run", &C::least_stationary_run, "Stationary beams side by side that do.", Range{1, 4096}},
      {"longest_mover_m", &C::longest_mover_m, "What is longer does not move as one thing.", kPositive},
      {"range_noise_m", &C::range_noise_m, "One sigma at the scanner.", kPositive},
      {"range_noise_per_m", &C::range_noise_per_m, "What each metre of range adds to it.", kNotNegative},
      {"ground_least_width_m", &C::ground_least_width_m, "A line on the ground is at least so wide across the vehicle's axis.",
       kNotNegative},
      {"ground_thickness_m", &C::ground_thickness_m, "A line on the ground is at most so thick.", kNotNegative},
      {"ground_heading_rad", &C::ground_heading_rad, "A line on the ground is that square to the vehicle's axis.", kNotNegative},
      {"ground_nearest_m", &C::ground_nearest_m, "The ground is not hit nearer than this.", kNotNegative},
      {"ground_most_beyond", &C::ground_most_beyond, "Share of the beams on a line on the ground that may see beyond it.", kShare},
      {"occluder_margin_m", &C::occluder_margin_m, "A neighbouring echo nearer by this hides what lies behind it.",
       kNotNegative},
  };
}

}  // namespace

const FieldTable<DetectionConfig>& detection_fields() {
  static const FieldTable<DetectionConfig> table =
      config::with_nested(own_fields(), "segmentation", &DetectionConfig::segmentation, segmentation_fields());
  return table;
}

}  // namespace slammot::detection
