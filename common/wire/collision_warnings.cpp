#include "common/wire/collision_warnings.hpp"

#include <algorithm>
#include <tuple>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"

namespace slammot::wire {
namespace {

static_assert(static_cast<int>(flow::WarningLevel::kNone) == slammot_WARNING_LEVEL_NONE);
static_assert(static_cast<int>(flow::WarningLevel::kCaution) == slammot_WARNING_LEVEL_CAUTION);
static_assert(static_cast<int>(flow::WarningLevel::kWarning) == slammot_WARNING_LEVEL_WARNING);

slammot_CollisionWarning encode_object(const flow::CollisionWarning& object) {
  slammot_CollisionWarning sample{};
  sample.track_id = object.track_id.value;
  sample.level = static_cast<slammot_WarningLevel>(object.level);
  sample.probability = object.probability;
  sample.time_to_collision_s = object.time_to_collision_s;
  sample.closest_distance_m = object.closest_distance_m;
  sample.time_to_closest_s = object.time_to_closest_s;
  return sample;
}

flow::CollisionWarning decode_object(const slammot_CollisionWarning& sample) {
  return {{sample.track_id},         static_cast<flow::WarningLevel>(sample.level),
          sample.probability,        sample.time_to_collision_s,
          sample.closest_distance_m, sample.time_to_closest_s};
}

std::string_view fault_of(const slammot_CollisionWarning& object) {
  if (!is_enumerator(object.level, slammot_WARNING_LEVEL_WARNING)) return "a level is unknown";
  if (!is_probability(object.probability)) return "a probability is not within 0 and 1";
  if (!is_sound(object.time_to_collision_s)) return "a time to collision is not finite";
  if (!is_amount(object.closest_distance_m) || !is_amount(object.time_to_closest_s))
    return "a closest approach is negative or not finite";
  return "";
}

std::string_view fault_of(const slammot_CollisionWarnings& sample) {
  if (!is_amount(sample.horizon_s)) return "horizon_s is negative or not finite";
  if (!is_enumerator(sample.highest_level, slammot_WARNING_LEVEL_WARNING))
    return "highest_level is unknown";
  for (const slammot_CollisionWarning& object : elements(sample.objects)) {
    if (const std::string_view fault = fault_of(object); !fault.empty()) return fault;
  }
  return "";
}

bool is_more_urgent(const slammot_CollisionWarning& a, const slammot_CollisionWarning& b) {
  return std::tuple(a.level, a.probability) > std::tuple(b.level, b.probability);
}

}  // namespace

const slammot_CollisionWarnings& CollisionWarningsEncoder::encode(
    std::string_view vehicle_id, const flow::CollisionWarnings& warnings) {
  objects_.clear();
  for (const flow::CollisionWarning& object : warnings.objects)
    objects_.push_back(encode_object(object));
  if (objects_.size() > kMostObjects) {
    std::ranges::stable_sort(objects_, is_more_urgent);
    objects_.resize(kMostObjects);
  }
  set_text(sample_.vehicle_id, vehicle_id);
  sample_.stamp_ns = warnings.stamp_ns;
  sample_.sequence_number = warnings.sequence;
  sample_.map_id = warnings.map_id.value;
  sample_.odom_id = warnings.odom_id.value;
  sample_.horizon_s = warnings.horizon_s;
  sample_.highest_level = static_cast<slammot_WarningLevel>(warnings.highest_level);
  show(sample_.objects, objects_);
  return sample_;
}

Decoded<flow::CollisionWarnings> decode(const slammot_CollisionWarnings& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  flow::CollisionWarnings warnings{
      .stamp_ns = sample.stamp_ns,
      .sequence = sample.sequence_number,
      .map_id = {sample.map_id},
      .odom_id = {sample.odom_id},
      .horizon_s = sample.horizon_s,
      .highest_level = static_cast<flow::WarningLevel>(sample.highest_level),
      .objects = {}};
  for (const slammot_CollisionWarning& object : elements(sample.objects))
    warnings.objects.push_back(decode_object(object));
  return warnings;
}

}  // namespace slammot::wire
