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

/// A writer or reader elsewhere that uses the same topic in a way that cannot be connected.
struct QosMismatch {
  std::string topic_name;
  std::string policy;       ///< Name of the policy of the last one, e.g. "reliability".
  std::uint32_t total = 0;  ///< Endpoints met so far that did not fit.

  /// One line for the log.
  std::string text() const;
};

/// What reader and writer have in common: a topic in a participant, and the other side.
class Endpoint {
 public:
  Entity::Handle handle() const { return entity_.handle(); }
  const TopicInfo& topic() const { return *info_; }

 protected:
  friend class LoanBase;
  enum class Side { kReader, kWriter };

  Endpoint(const Participant& participant, const TopicInfo& info, Side side, const dds_qos* qos);

  std::string describe(const char* call) const;
  /// Sleeps until `enough()`, which is asked again whenever somebody on the other side comes,
  /// goes or does not fit.
  bool wait_until(const std::function<bool()>& enough, std::chrono::nanoseconds timeout) const;
  std::optional<QosMismatch> mismatch(std::uint32_t total, std::uint32_t last_policy_id) const;

 private:
  const TopicInfo* info_;
  Entity topic_;  // before entity_: deleted after it
  Entity entity_;
};

}  // namespace slammot::dds
