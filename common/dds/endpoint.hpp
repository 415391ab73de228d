#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "common/dds/entity.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/topic_table.hpp"

struct dds_qos;

namespace slammot::dds {

/// A remote writer or reader of the same topic with incompatible QoS.
struct QosMismatch {
  std::string topic_name;
  std::string policy;       ///< Name of the last incompatible policy, e.g. "reliability".
  std::uint32_t total = 0;  ///< Number of incompatible endpoints so far.

  /// One line for the log.
  std::string text() const;
};

/// Common base of reader and writer: a topic of a participant, and the matched endpoints.
class Endpoint {
 public:
  Entity::Handle handle() const { return entity_.handle(); }
  const TopicInfo& topic() const { return *info_; }
  /// As in SampleInfo::writer_handle.
  std::uint64_t instance_handle() const;

 protected:
  friend class LoanBase;
  enum class Side { kReader, kWriter };

  Endpoint(const Participant& participant, const TopicInfo& info, Side side, const dds_qos* qos);
  /// Of a topic that was made otherwise than from a compiled type.
  Endpoint(const Participant& participant, const TopicInfo& info, Entity topic, Side side,
           const dds_qos* qos);

  std::string describe(const char* call) const;
  /// Sleeps until `enough()`; tests it again whenever an endpoint matches, leaves or is
  /// incompatible.
  bool wait_until(const std::function<bool()>& enough, std::chrono::nanoseconds timeout) const;
  std::optional<QosMismatch> mismatch(std::uint32_t total, std::uint32_t last_policy_id) const;

 private:
  const TopicInfo* info_;
  Entity topic_;  // before entity_: deleted after it
  Entity entity_;
};

}  // namespace slammot::dds
