#include "common/wire/truth.hpp"

#include <algorithm>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

using simulation::ObjectTruth;

slammot_TrueObject encode(const ObjectTruth& object) {
  slammot_TrueObject sample{};
  sample.object_id = static_cast<std::uint32_t>(object.id);
  sample.object_class = static_cast<slammot_TrueClass>(object.kind);
  sample.world_from_object = wire::encode(object.world_from_object);
  sample.speed_mps = object.speed_mps;
  sample.length_m = object.size.length_m;
  sample.width_m = object.size.width_m;
  sample.visible_points = static_cast<std::uint32_t>(object.points);
  sample.distance_m = object.range_m;
  return sample;
}

std::string_view fault_of(const slammot_TrueObject& object) {
  if (!is_enumerator(object.object_class, slammot_TRUE_CLASS_PEDESTRIAN))
    return "object_class is none of the enumerators";
  if (!is_sound(object.world_from_object) || !is_sound(object.speed_mps))
    return "world_from_object or speed_mps is not finite";
  if (!is_amount(object.length_m) || !is_amount(object.width_m) || !is_amount(object.distance_m))
    return "a size or a distance is unsound";
  return "";
}

ObjectTruth decode(const slammot_TrueObject& sample) {
  return {static_cast<int>(sample.object_id),
          static_cast<simulation::ObjectClass>(sample.object_class),
          {sample.length_m, sample.width_m},
          wire::decode(sample.world_from_object),
          sample.speed_mps,
          static_cast<int>(sample.visible_points),
          sample.distance_m};
}

template <typename Sample>
void encode_header(std::string_view vehicle_id, const sensing::LaserScan& scan, Sample& sample) {
  set_text(sample.vehicle_id, vehicle_id);
  set_text(sample.scanner_id, scan.scanner.scanner_id);
  sample.stamp_ns = scan.stamp_ns;
  sample.sequence_number = scan.sequence;
}

}  // namespace

TruthEncoder::TruthEncoder(std::uint64_t drive_id) {
  pose_.drive_id = objects_.drive_id = hits_.drive_id = drive_id;
}

const slammot_TruePose& TruthEncoder::encode_pose(std::string_view vehicle_id,
                                                  const simulation::SimulatedScan& scan) {
  set_text(pose_.vehicle_id, vehicle_id);
  pose_.stamp_ns = scan.scan.stamp_ns;
  pose_.world_from_base = wire::encode(scan.world_from_base);
  pose_.speed_mps = scan.speed_mps;
  pose_.yaw_rate_radps = scan.yaw_rate_radps;
  pose_.nose_down_rad = scan.nose_down_rad;
  return pose_;
}

const slammot_TrueObjects& TruthEncoder::encode_objects(std::string_view vehicle_id,
                                                        const simulation::SimulatedScan& scan) {
  encode_header(vehicle_id, scan.scan, objects_);
  object_buffer_.clear();
  for (const auto* objects : {&scan.objects, &scan.unseen}) {
    for (const ObjectTruth& object : *objects) object_buffer_.push_back(encode(object));
  }
  if (object_buffer_.size() > kMostTrueObjects) {
    std::ranges::nth_element(object_buffer_, object_buffer_.begin() + kMostTrueObjects, {},
                             &slammot_TrueObject::distance_m);
    object_buffer_.resize(kMostTrueObjects);
  }
  std::ranges::sort(object_buffer_, {}, &slammot_TrueObject::object_id);
  show(objects_.objects, object_buffer_);
  return objects_;
}

const slammot_TrueHits& TruthEncoder::encode_hits(std::string_view vehicle_id,
                                                  const simulation::SimulatedScan& scan) {
  encode_header(vehicle_id, scan.scan, hits_);
  hit_buffer_.assign(scan.hits.begin(), scan.hits.end());
  show(hits_.hit_objects, hit_buffer_);
  return hits_;
}

Decoded<TruePose> decode(const slammot_TruePose& sample) {
  if (!is_sound(sample.world_from_base)) return Fault{"world_from_base is not finite"};
  if (!is_sound(sample.speed_mps) || !is_sound(sample.yaw_rate_radps) ||
      !is_sound(sample.nose_down_rad))
    return Fault{"a rate or an angle is not finite"};
  return TruePose{sample.stamp_ns, decode(sample.world_from_base), sample.speed_mps,
                  sample.yaw_rate_radps, sample.nose_down_rad};
}

Decoded<TrueObjects> decode(const slammot_TrueObjects& sample) {
  TrueObjects truth{
      sample.stamp_ns, sample.sequence_number, std::string(text(sample.scanner_id)), {}};
  for (const slammot_TrueObject& object : elements(sample.objects)) {
    if (const std::string_view fault = fault_of(object); !fault.empty()) return Fault{fault};
    truth.objects.push_back(decode(object));
  }
  return truth;
}

Decoded<TrueHits> decode(const slammot_TrueHits& sample) {
  TrueHits truth{sample.stamp_ns, sample.sequence_number, std::string(text(sample.scanner_id)), {}};
  for (const std::int32_t hit : elements(sample.hit_objects)) {
    if (hit < simulation::kHitSeveral) return Fault{"a hit that means nothing"};
    truth.hits.push_back(hit);
  }
  return truth;
}

}  // namespace slammot::wire
