#include "common/dds/endpoint_qos.hpp"

#include <algorithm>
#include <cstdio>

#include <dds/ddsi/ddsi_serdata.h>  // before the next one, which needs it
#include <dds/ddsi/ddsi_typelib.h>

namespace slammot::dds {
namespace {

using Liveliness = EndpointQos::Liveliness;

const char* name_of(EndpointQos::Durability durability) {
  static constexpr const char* kNames[] = {"volatile", "transient-local", "transient",
                                           "persistent"};
  return kNames[static_cast<int>(durability)];
}

const char* name_of(Liveliness liveliness) {
  static constexpr const char* kNames[] = {"automatic", "manual-by-participant", "manual-by-topic"};
  return kNames[static_cast<int>(liveliness)];
}

const char* reliability_name(const EndpointQos& qos) {
  return qos.is_reliable ? "reliable" : "best-effort";
}

std::string milliseconds(std::int64_t duration_ns) {
  if (duration_ns == EndpointQos::kUnlimited) return "unlimited";
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", static_cast<double>(duration_ns) * 1e-6);
  return text;
}

std::int64_t limited(dds_duration_t duration) {
  return duration == DDS_INFINITY ? EndpointQos::kUnlimited : duration;
}

bool is_longer(std::int64_t offered_ns, std::int64_t requested_ns) {
  if (requested_ns == EndpointQos::kUnlimited) return false;
  return offered_ns == EndpointQos::kUnlimited || offered_ns > requested_ns;
}

bool share_a_partition(std::vector<std::string> a, std::vector<std::string> b) {
  if (a.empty()) a.emplace_back();
  if (b.empty()) b.emplace_back();
  const auto is_pattern = [](const std::string& name) {
    return name.find_first_of("*?") != std::string::npos;
  };
  return std::ranges::any_of(a, [&](const std::string& name) {
    return is_pattern(name) || std::ranges::any_of(b, [&](const std::string& other) {
             return other == name || is_pattern(other);
           });
  });
}

std::vector<std::string> partitions_of(const dds_qos_t* qos) {
  std::uint32_t count = 0;
  char** names = nullptr;
  std::vector<std::string> partitions;
  if (!dds_qget_partition(qos, &count, &names)) return partitions;
  for (std::uint32_t i = 0; i < count; ++i) {
    partitions.emplace_back(names[i]);
    dds_free(names[i]);
  }
  dds_free(names);
  return partitions;
}

}  // namespace

EndpointQos endpoint_qos(const dds_qos_t* qos) {
  EndpointQos result;
  dds_reliability_kind_t reliability;
  dds_duration_t duration = 0;
  if (dds_qget_reliability(qos, &reliability, &duration))
    result.is_reliable = reliability == DDS_RELIABILITY_RELIABLE;
  dds_durability_kind_t durability;
  if (dds_qget_durability(qos, &durability))
    result.durability = static_cast<EndpointQos::Durability>(durability);
  dds_history_kind_t history;
  std::int32_t depth = 1;
  if (dds_qget_history(qos, &history, &depth))
    result.depth = history == DDS_HISTORY_KEEP_ALL ? 0 : depth;
  dds_liveliness_kind_t liveliness;
  if (dds_qget_liveliness(qos, &liveliness, &duration)) {
    result.liveliness = static_cast<Liveliness>(liveliness);
    result.lease_ns = limited(duration);
  }
  if (dds_qget_deadline(qos, &duration)) result.deadline_ns = limited(duration);
  if (dds_qget_lifespan(qos, &duration)) result.lifespan_ns = limited(duration);
  dds_ownership_kind_t ownership;
  if (dds_qget_ownership(qos, &ownership))
    result.is_exclusive = ownership == DDS_OWNERSHIP_EXCLUSIVE;
  dds_destination_order_kind_t order;
  if (dds_qget_destination_order(qos, &order))
    result.is_by_source_time = order == DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP;
  result.partitions = partitions_of(qos);
  return result;
}

const dds_typeinfo_t* type_information(dds_builtintopic_endpoint_t& endpoint) {
  const dds_typeinfo_t* information = nullptr;
  const bool is_told =
      dds_builtintopic_get_endpoint_type_info(&endpoint, &information) == DDS_RETCODE_OK &&
      information != nullptr && ddsi_typeinfo_present(information);
  return is_told ? information : nullptr;
}

std::vector<unsigned char> type_hash(dds_builtintopic_endpoint_t& endpoint) {
  const dds_typeinfo_t* const info = type_information(endpoint);
  if (info == nullptr) return {};
  ddsi_typeid_t* const id = ddsi_typeinfo_typeid(info, DDSI_TYPEID_KIND_COMPLETE);
  if (id == nullptr) return {};
  unsigned char* bytes = nullptr;
  std::uint32_t size = 0;
  ddsi_typeid_ser(id, &bytes, &size);
  std::vector<unsigned char> hash(bytes, bytes + size);
  dds_free(bytes);
  ddsi_typeid_fini(id);
  dds_free(id);
  return hash;
}

std::string EndpointQos::text() const {
  std::string text = reliability_name(*this);
  const auto add = [&text](const char* words, const std::string& value = {}) {
    text.append(words).append(value);
  };
  add(", ", name_of(durability));
  add(depth == 0 ? ", keep-all" : ", keep-last ", depth == 0 ? "" : std::to_string(depth));
  add(", ", name_of(liveliness));
  if (lease_ns != kUnlimited) add(" ", milliseconds(lease_ns));
  if (deadline_ns != kUnlimited) add(", deadline ", milliseconds(deadline_ns));
  if (lifespan_ns != kUnlimited) add(", lifespan ", milliseconds(lifespan_ns));
  if (is_exclusive) add(", exclusive");
  if (is_by_source_time) add(", by source time");
  for (const std::string& partition : partitions) add(", partition '", partition + "'");
  return text;
}

std::vector<std::string> incompatibilities(const EndpointQos& writer, const EndpointQos& reader) {
  std::vector<std::string> reasons;
  if (reader.is_reliable && !writer.is_reliable)
    reasons.emplace_back(
        "reliability: the reader asks for reliable, the writer offers best-effort");
  if (reader.durability > writer.durability)
    reasons.emplace_back(std::string("durability: the reader asks for ") +
                         name_of(reader.durability) + ", the writer offers " +
                         name_of(writer.durability));
  if (is_longer(writer.deadline_ns, reader.deadline_ns))
    reasons.emplace_back("deadline: the reader asks for a sample every " +
                         milliseconds(reader.deadline_ns) + ", the writer promises " +
                         milliseconds(writer.deadline_ns));
  if (reader.liveliness > writer.liveliness)
    reasons.emplace_back(std::string("liveliness: the reader asks for ") +
                         name_of(reader.liveliness) + ", the writer offers " +
                         name_of(writer.liveliness));
  if (is_longer(writer.lease_ns, reader.lease_ns))
    reasons.emplace_back("liveliness lease: the reader asks for " + milliseconds(reader.lease_ns) +
                         ", the writer offers " + milliseconds(writer.lease_ns));
  if (reader.is_exclusive != writer.is_exclusive)
    reasons.emplace_back(std::string("ownership: one is exclusive, the other shared (writer: ") +
                         (writer.is_exclusive ? "exclusive)" : "shared)"));
  if (reader.is_by_source_time && !writer.is_by_source_time)
    reasons.emplace_back(
        "destination order: the reader asks for the order by source time, the writer offers that "
        "of reception");
  if (!share_a_partition(writer.partitions, reader.partitions))
    reasons.emplace_back("partition: they have none in common");
  return reasons;
}

}  // namespace slammot::dds
