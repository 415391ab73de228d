#include "common/dds/offered_qos.hpp"

#include <charconv>

#include <dds/dds.h>

#include "common/dds/endpoint_qos.hpp"

namespace slammot::dds {
namespace {

std::optional<std::int64_t> number_in(const std::map<std::string, std::string>& texts,
                                      const char* key) {
  const auto text = texts.find(key);
  std::int64_t number = 0;
  if (text == texts.end()) return std::nullopt;
  const char* const end = text->second.data() + text->second.size();
  const auto [at, error] = std::from_chars(text->second.data(), end, number);
  return error == std::errc() && at == end ? std::optional(number) : std::nullopt;
}

bool is(const std::map<std::string, std::string>& texts, const char* key, const char* word,
        bool otherwise) {
  const auto text = texts.find(key);
  return text == texts.end() ? otherwise : text->second == word;
}

}  // namespace

OfferedQos offered_qos_of(const dds_qos* qos) {
  const EndpointQos told = endpoint_qos(qos);
  OfferedQos offered;
  offered.is_reliable = told.is_reliable;
  offered.is_transient_local = told.durability != EndpointQos::Durability::kVolatile;
  offered.is_exclusive = told.is_exclusive;
  offered.depth = told.depth;
  offered.partitions = told.partitions;
  if (told.lifespan_ns != EndpointQos::kUnlimited) offered.lifespan_ns = told.lifespan_ns;
  if (told.liveliness == EndpointQos::Liveliness::kManualByTopic)
    offered.manual_liveliness_ns =
        told.lease_ns == EndpointQos::kUnlimited ? DDS_INFINITY : told.lease_ns;
  dds_qget_ownership_strength(qos, &offered.ownership_strength);
  std::uint32_t count = 0;
  dds_data_representation_id_t* representations = nullptr;
  if (dds_qget_data_representation(qos, &count, &representations)) {
    if (count > 0) offered.representation = representations[0];
    dds_free(representations);
  }
  return offered;
}

void set_partitions(const OfferedQos& offered, dds_qos* qos) {
  std::vector<const char*> names;
  for (const std::string& partition : offered.partitions) names.push_back(partition.c_str());
  if (!names.empty())
    dds_qset_partition(qos, static_cast<std::uint32_t>(names.size()), names.data());
}

std::map<std::string, std::string> texts_of(const OfferedQos& qos) {
  std::map<std::string, std::string> texts = {
      {"qos.reliability", qos.is_reliable ? "reliable" : "best_effort"},
      {"qos.durability", qos.is_transient_local ? "transient_local" : "volatile"},
      {"qos.ownership", qos.is_exclusive ? "exclusive" : "shared"},
      {"qos.depth", std::to_string(qos.depth)},
      {"qos.representation", std::to_string(qos.representation)}};
  if (qos.is_exclusive) texts["qos.ownership_strength"] = std::to_string(qos.ownership_strength);
  if (qos.lifespan_ns) texts["qos.lifespan_ns"] = std::to_string(*qos.lifespan_ns);
  if (qos.manual_liveliness_ns)
    texts["qos.manual_liveliness_ns"] = std::to_string(*qos.manual_liveliness_ns);
  for (const std::string& partition : qos.partitions) texts["qos.partition:" + partition] = "";
  return texts;
}

OfferedQos offered_qos_of(const std::map<std::string, std::string>& texts) {
  constexpr std::string_view kPartition = "qos.partition:";
  constexpr std::int64_t kDeepest = 10'000;
  OfferedQos qos;
  qos.is_reliable = is(texts, "qos.reliability", "reliable", true);
  qos.is_transient_local = is(texts, "qos.durability", "transient_local", false);
  qos.is_exclusive = is(texts, "qos.ownership", "exclusive", false);
  qos.ownership_strength =
      static_cast<std::int32_t>(number_in(texts, "qos.ownership_strength").value_or(0));
  const std::int64_t depth = number_in(texts, "qos.depth").value_or(1);
  qos.depth = depth < 0 || depth > kDeepest ? 1 : static_cast<std::int32_t>(depth);
  qos.lifespan_ns = number_in(texts, "qos.lifespan_ns");
  if (qos.lifespan_ns && *qos.lifespan_ns <= 0) qos.lifespan_ns.reset();
  qos.manual_liveliness_ns = number_in(texts, "qos.manual_liveliness_ns");
  if (qos.manual_liveliness_ns && *qos.manual_liveliness_ns <= 0) qos.manual_liveliness_ns.reset();
  const std::int64_t representation = number_in(texts, "qos.representation").value_or(0);
  qos.representation = representation == 2 ? 2 : 0;
  for (const auto& [key, value] : texts) {
    if (key.starts_with(kPartition)) qos.partitions.push_back(key.substr(kPartition.size()));
  }
  return qos;
}

}  // namespace slammot::dds
