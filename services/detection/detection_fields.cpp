#include "services/detection/detection_fields.hpp"

namespace slammot::detection {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::joined;
using config::kNotNegative;
using config::kPositive;

FieldTable<sensing::SegmentationConfig> segmentation_fields() {
  using C = sensing::SegmentationConfig;
  return in_group<C>(
      Group::extent,
      {
          {"gap_m",
           &C::gap_m,
           "Neighbouring echoes farther apart than this, close to the scanner, are of different "
           "things.",
           kNotNegative,
           {"One body falls into pieces.", "A pedestrian beside a wall becomes part of it."}},
          {"widest_gap_m",
           &C::widest_gap_m,
           "At no distance is the gap within a body wider.",
           kPositive,
           {"Distant bodies fall into pieces.", "Distant bodies side by side become one."}},
          {"line_gap_m",
           &C::line_gap_m,
           "A straight wall seen at a grazing angle goes on across so wide a gap.",
           kNotNegative,
           {"Distant walls fall into pieces that look like bodies.",
            "Gaps in walls, where someone may stand, are bridged."}},
          {"line_tolerance_m",
           &C::line_tolerance_m,
           "The next echo lies this near to the wall's line.",
           kPositive,
           {"Noise breaks walls.", "What leans on a wall becomes part of it."}},
          {"dark_gap_m",
           &C::dark_gap_m,
           "Sparse echoes of something dark on a line lie no farther apart.",
           kNotNegative,
           {"A dark car falls into single echoes.",
            "Single echoes of different bodies become one."}},
      });
}

FieldTable<DetectionConfig> own_fields() {
  using C = DetectionConfig;
  return joined<C>({
      in_group<C>(Group::motion, {{"longest_mover_m",
                                   &C::longest_mover_m,
                                   "What is longer does not move as one thing.",
                                   kPositive,
                                   {"Long vehicles are not detected.",
                                    "Walls that come into view seem to move."}}}),
      in_group<C>(Group::sensor, {{"range_noise_m",
                                   &C::range_noise_m,
                                   "One sigma of a range, for published segments.",
                                   kPositive,
                                   {"Tracks follow noise and claim to be surer than they are.",
                                    "Tracks are sluggish."}}}),
  });
}

}  // namespace

const FieldTable<DetectionConfig>& detection_fields() {
  static const FieldTable<DetectionConfig> table = config::with_nested(
      own_fields(), "segmentation", &DetectionConfig::segmentation, segmentation_fields());
  return table;
}

}  // namespace slammot::detection
