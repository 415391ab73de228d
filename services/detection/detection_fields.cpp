#include "services/detection/detection_fields.hpp"

#include "common/config/physical_ranges.hpp"

namespace slammot::detection {
namespace {

using config::FieldTable;
using config::Group;
using config::in_group;
using config::joined;
using config::kLength_m;
using config::kLengthOrZero_m;

FieldTable<sensing::SegmentationConfig> segmentation_fields() {
  using C = sensing::SegmentationConfig;
  return in_group<C>(
      Group::extent,
      {
          {"gap_m",
           &C::gap_m,
           "Greatest distance of neighbouring echoes of one segment, close to the scanner. "
           "Greatest gaps at any range, along walls and of dark objects, and distances of echoes "
           "from a wall's line are multiples of it.",
           kLengthOrZero_m,
           {"One object is split.", "A pedestrian beside a wall is merged with it."}},
      });
}

FieldTable<DetectionConfig> own_fields() {
  using C = DetectionConfig;
  return joined<C>({
      in_group<C>(Group::motion, {{"longest_mover_m",
                                   &C::longest_mover_m,
                                   "Longest segment that is labelled moving.",
                                   kLength_m,
                                   {"Long vehicles are not detected.",
                                    "Walls that come into view are labelled moving."}}}),
      in_group<C>(Group::sensor,
                  {{"range_noise_m",
                    &C::range_noise_m,
                    "One sigma of a range, for published segments.",
                    kLength_m,
                    {"Tracks follow noise and are overconfident.", "Tracks are sluggish."}}}),
  });
}

}  // namespace

const FieldTable<DetectionConfig>& detection_fields() {
  static const FieldTable<DetectionConfig> table = config::with_nested(
      own_fields(), "segmentation", &DetectionConfig::segmentation, segmentation_fields());
  return table;
}

}  // namespace slammot::detection
