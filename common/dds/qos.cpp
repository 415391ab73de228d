#include "common/dds/qos.hpp"

#include <array>

#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {

using namespace std::chrono_literals;

QosProfile qos_profile(Flow flow) {
  switch (flow) {
    case Flow::kSensor:
      return {.depth = 20};
    case Flow::kEstimate:
      return {.depth = 4};
    case Flow::kTile:
    case Flow::kGraph:
    case Flow::kStatus:
      return {.durability = Durability::kTransientLocal};
    case Flow::kHeartbeat:
      return {.manual_liveliness = 1000ms};
    case Flow::kCommand:
      return {.depth = 8, .lifespan = 10s};
  }
  return {};
}

std::string qos_policy_name(std::uint32_t policy_id) {
  // The order of Cyclone's dds_qos_policy_id_t, which is that of DDS 1.4 as far as that goes.
  static constexpr std::array kNames = {
      "invalid",           "user data",
      "durability",        "presentation",
      "deadline",          "latency budget",
      "ownership",         "ownership strength",
      "liveliness",        "time-based filter",
      "partition",         "reliability",
      "destination order", "history",
      "resource limits",   "entity factory",
      "writer lifecycle",  "reader lifecycle",
      "topic data",        "group data",
      "transport priority", "lifespan",
      "durability service", "property",
      "type",              "data representation"};
  return policy_id < kNames.size() ? kNames[policy_id] : "policy " + std::to_string(policy_id);
}

QosPointer make_qos(const QosProfile& profile) {
  const auto nanoseconds = [](std::chrono::milliseconds time) { return std::chrono::nanoseconds(time).count(); };
  QosPointer qos(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, nanoseconds(profile.max_blocking));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, profile.depth);
  // By the reader's clock: with clocks 2 s apart a neighbour's samples would be dropped as old.
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  // A writer that dies takes nothing back.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  if (profile.durability == Durability::kTransientLocal) {
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, profile.depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  }
  if (profile.lifespan) dds_qset_lifespan(qos.get(), nanoseconds(*profile.lifespan));
  if (profile.manual_liveliness) {
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, nanoseconds(*profile.manual_liveliness));
  }
  return qos;
}

}  // namespace slammot::dds
