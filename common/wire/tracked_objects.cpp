#include "common/wire/tracked_objects.hpp"

#include <algorithm>
#include <tuple>

#include "common/wire/parts.hpp"
#include "common/wire/text.hpp"

namespace slammot::wire {
namespace {

constexpr std::size_t kMostContourPointsOfAll = 3072;
constexpr std::size_t kMostPredictedPositionsOfAll = 768;

static_assert(static_cast<int>(flow::Motion::kMoving) == slammot_MOTION_MOVING);
static_assert(static_cast<int>(flow::Motion::kStopped) == slammot_MOTION_STOPPED);
static_assert(static_cast<int>(flow::ObjectClass::kUnknown) == slammot_OBJECT_CLASS_UNKNOWN);
static_assert(static_cast<int>(flow::ObjectClass::kPedestrian) == slammot_OBJECT_CLASS_PEDESTRIAN);
static_assert(static_cast<int>(flow::ObjectClass::kBicycle) == slammot_OBJECT_CLASS_BICYCLE);
static_assert(static_cast<int>(flow::ObjectClass::kCar) == slammot_OBJECT_CLASS_CAR);
static_assert(static_cast<int>(flow::ObjectClass::kTruckOrBus) ==
              slammot_OBJECT_CLASS_TRUCK_OR_BUS);
static_assert(sizeof(slammot_TrackedObject::class_probability) / sizeof(double) ==
              std::tuple_size_v<flow::ClassProbabilities>);

/// What one object may take of a list that all share.
std::size_t share(std::size_t of_one, std::size_t of_all, std::size_t objects) {
  return std::min(of_one, of_all / std::max<std::size_t>(objects, 1));
}

slammot_TrackedObject encode_object(const flow::TrackedObject& object) {
  slammot_TrackedObject sample{};
  sample.track_id = object.track_id.value;
  sample.confirmed = object.confirmed;
  sample.existence = object.existence;
  sample.position_in_odom_m = encode(object.position_in_odom_m);
  sample.velocity_in_odom_mps = encode(object.velocity_in_odom_mps);
  encode_matrix<4>(object.covariance, sample.covariance);
  sample.acceleration_in_odom_mps2 = encode(object.acceleration_in_odom_mps2);
  sample.heading_in_odom_rad = object.heading_in_odom_rad;
  sample.length_m = object.length_m;
  sample.width_m = object.width_m;
  sample.motion_state = static_cast<slammot_Motion>(object.motion);
  sample.object_class = static_cast<slammot_ObjectClass>(object.object_class);
  std::copy(object.mode_probability.begin(), object.mode_probability.end(),
            sample.mode_probability);
  std::copy(object.class_probability.begin(), object.class_probability.end(),
            sample.class_probability);
  sample.first_seen_ns = object.first_seen_ns;
  sample.last_seen_ns = object.last_seen_ns;
  sample.occluded = object.occluded;
  return sample;
}

flow::TrackedObject decode_object(const slammot_TrackedObject& sample) {
  flow::TrackedObject object{.track_id = {sample.track_id},
                             .confirmed = sample.confirmed,
                             .existence = sample.existence,
                             .position_in_odom_m = decode(sample.position_in_odom_m),
                             .velocity_in_odom_mps = decode(sample.velocity_in_odom_mps),
                             .covariance = decode_matrix<4>(sample.covariance),
                             .acceleration_in_odom_mps2 = decode(sample.acceleration_in_odom_mps2),
                             .heading_in_odom_rad = sample.heading_in_odom_rad,
                             .length_m = sample.length_m,
                             .width_m = sample.width_m,
                             .motion = static_cast<flow::Motion>(sample.motion_state),
                             .object_class = static_cast<flow::ObjectClass>(sample.object_class),
                             .mode_probability = {},
                             .first_seen_ns = sample.first_seen_ns,
                             .last_seen_ns = sample.last_seen_ns,
                             .contour_in_odom_m = {},
                             .predicted_path = {},
                             .class_probability = {},
                             .occluded = sample.occluded};
  std::copy_n(sample.mode_probability, object.mode_probability.size(),
              object.mode_probability.begin());
  std::copy_n(sample.class_probability, object.class_probability.size(),
              object.class_probability.begin());
  return object;
}

std::string_view fault_of(const slammot_TrackedObject& object) {
  if (!is_probability(object.existence)) return "existence is not within 0 and 1";
  if (!is_sound(object.position_in_odom_m)) return "a position is not finite";
  if (!is_sound(object.velocity_in_odom_mps)) return "a velocity is not finite";
  if (!is_covariance<4>(object.covariance)) return "a covariance is unsound";
  if (!is_sound(object.acceleration_in_odom_mps2)) return "an acceleration is not finite";
  if (!is_sound(object.heading_in_odom_rad)) return "a heading is not finite";
  if (!is_amount(object.length_m) || !is_amount(object.width_m)) return "a box has no sound size";
  if (!is_enumerator(object.motion_state, slammot_MOTION_STOPPED)) return "motion_state is unknown";
  if (!is_enumerator(object.object_class, slammot_OBJECT_CLASS_TRUCK_OR_BUS))
    return "object_class is unknown";
  for (const double probability : object.mode_probability) {
    if (!is_probability(probability)) return "a mode's probability is not within 0 and 1";
  }
  for (const double probability : object.class_probability) {
    if (!is_probability(probability)) return "a class's probability is not within 0 and 1";
  }
  return "";
}

std::string_view fault_of(const slammot_TrackedObjects& sample) {
  if (!is_sound(sample.map_from_odom)) return "map_from_odom is not finite";
  if (!is_sound(sample.odom_from_base)) return "odom_from_base is not finite";
  std::size_t contour_points = 0;
  std::size_t path_points = 0;
  for (const slammot_TrackedObject& object : elements(sample.objects)) {
    if (const std::string_view fault = fault_of(object); !fault.empty()) return fault;
    contour_points += object.contour_count;
    path_points += object.path_count;
  }
  if (contour_points != sample.contour_points._length)
    return "contour_points does not have what the objects count";
  if (path_points != sample.path_points._length)
    return "path_points does not have what the objects count";
  for (const slammot_Point2f& point : elements(sample.contour_points)) {
    if (!is_sound(point)) return "a contour is not finite";
  }
  for (const slammot_PredictedPosition& position : elements(sample.path_points)) {
    if (!is_amount(position.after_s) || !is_sound(position.position_in_odom_m))
      return "a path is not finite";
    if (!is_covariance<2>(position.covariance_m2)) return "a path's covariance is unsound";
  }
  return "";
}

}  // namespace

void TrackedObjectsEncoder::choose(const std::vector<flow::TrackedObject>& objects) {
  chosen_.clear();
  for (const flow::TrackedObject& object : objects) chosen_.push_back(&object);
  if (chosen_.size() <= kMostObjects) return;
  std::stable_sort(chosen_.begin(), chosen_.end(),
                   [](const flow::TrackedObject* a, const flow::TrackedObject* b) {
                     return a->confirmed != b->confirmed ? a->confirmed
                                                         : a->existence > b->existence;
                   });
  chosen_.resize(kMostObjects);
}

void TrackedObjectsEncoder::encode_contour(const flow::TrackedObject& object,
                                           slammot_TrackedObject& sample) {
  const std::size_t room = share(kMostContourPoints, kMostContourPointsOfAll, chosen_.size());
  const std::vector<Eigen::Vector2f>& contour = object.contour_in_odom_m;
  const std::size_t count = std::min(room, contour.size());
  for (std::size_t i = 0; i < count; ++i) {
    contour_points_.push_back(wire::encode(contour[i * contour.size() / count]));
  }
  sample.contour_count = static_cast<std::uint16_t>(count);
}

void TrackedObjectsEncoder::encode_path(const flow::TrackedObject& object,
                                        slammot_TrackedObject& sample) {
  const std::size_t room =
      share(kMostPredictedPositions, kMostPredictedPositionsOfAll, chosen_.size());
  const std::size_t count = std::min(room, object.predicted_path.size());
  for (std::size_t i = 0; i < count; ++i) {
    const flow::PredictedPosition& position = object.predicted_path[i];
    slammot_PredictedPosition point{
        position.after_s, wire::encode(position.position_in_odom_m), {}};
    encode_matrix<2>(position.covariance_m2, point.covariance_m2);
    path_points_.push_back(point);
  }
  sample.path_count = static_cast<std::uint16_t>(count);
}

const slammot_TrackedObjects& TrackedObjectsEncoder::encode(std::string_view vehicle_id,
                                                            const flow::TrackedObjects& objects,
                                                            std::int64_t scan_published_ns) {
  choose(objects.objects);
  objects_.clear();
  contour_points_.clear();
  path_points_.clear();
  for (const flow::TrackedObject* object : chosen_) {
    slammot_TrackedObject& sample = objects_.emplace_back(encode_object(*object));
    encode_contour(*object, sample);
    encode_path(*object, sample);
  }
  set_text(sample_.vehicle_id, vehicle_id);
  sample_.scan_published_ns = scan_published_ns;
  sample_.stamp_ns = objects.stamp_ns;
  sample_.sequence_number = objects.sequence;
  sample_.map_from_odom = wire::encode(objects.map_from_odom);
  sample_.odom_from_base = wire::encode(objects.odom_from_base);
  sample_.map_id = objects.map_id.value;
  sample_.odom_id = objects.odom_id.value;
  show(sample_.objects, objects_);
  show(sample_.contour_points, contour_points_);
  show(sample_.path_points, path_points_);
  return sample_;
}

Decoded<flow::TrackedObjects> decode(const slammot_TrackedObjects& sample) {
  if (const std::string_view fault = fault_of(sample); !fault.empty()) return Fault{fault};
  flow::TrackedObjects objects{.stamp_ns = sample.stamp_ns,
                               .sequence = sample.sequence_number,
                               .map_from_odom = decode(sample.map_from_odom),
                               .odom_from_base = decode(sample.odom_from_base),
                               .objects = {},
                               .map_id = {sample.map_id},
                               .odom_id = {sample.odom_id}};
  objects.objects.reserve(sample.objects._length);
  auto contour = elements(sample.contour_points);
  auto path = elements(sample.path_points);
  for (const slammot_TrackedObject& of_wire : elements(sample.objects)) {
    flow::TrackedObject& object = objects.objects.emplace_back(decode_object(of_wire));
    for (const slammot_Point2f& point : contour.first(of_wire.contour_count)) {
      object.contour_in_odom_m.push_back(decode(point));
    }
    for (const slammot_PredictedPosition& position : path.first(of_wire.path_count)) {
      object.predicted_path.push_back({position.after_s, decode(position.position_in_odom_m),
                                       decode_matrix<2>(position.covariance_m2)});
    }
    contour = contour.subspan(of_wire.contour_count);
    path = path.subspan(of_wire.path_count);
  }
  return objects;
}

}  // namespace slammot::wire
