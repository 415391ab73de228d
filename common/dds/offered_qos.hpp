#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

struct dds_qos;

namespace slammot::dds {

/// QoS that a writer offers, as far as it decides which readers match and what they receive.
struct OfferedQos {
  bool is_reliable = true;
  bool is_transient_local = false;
  bool is_exclusive = false;  ///< Ownership.
  std::int32_t ownership_strength = 0;
  std::int32_t depth = 1;  ///< Of keep-last; 0: keep-all.
  std::optional<std::int64_t> lifespan_ns = std::nullopt;
  std::optional<std::int64_t> manual_liveliness_ns = std::nullopt;  ///< Asserted by each write.
  std::int16_t representation = 0;           ///< The first one offered: 0 for XCDR version 1, 2 for
                                             ///< version 2.
  std::vector<std::string> partitions = {};  ///< Empty: the default one.

  bool operator==(const OfferedQos&) const = default;
};

OfferedQos offered_qos_of(const dds_qos* qos);
/// The partitions, for a reader or writer.
void set_partitions(const OfferedQos& offered, dds_qos* qos);

/// As texts for a file: {"qos.reliability", "reliable"}, ... What is missing or not understood has
/// its default.
std::map<std::string, std::string> texts_of(const OfferedQos& qos);
OfferedQos offered_qos_of(const std::map<std::string, std::string>& texts);

}  // namespace slammot::dds
