#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/dds/offered_qos.hpp"
#include "common/dds/participant.hpp"

struct ddsi_typeinfo;

namespace slammot::dds {

/// A writer of another participant.
struct FoundWriter {
  std::string topic_name;
  std::string type_name;
  OfferedQos qos;
  std::shared_ptr<const ddsi_typeinfo> information;  ///< Null: it does not describe its type.
};

/// Lists the writers that join the bus.
class TopicDiscovery {
 public:
  explicit TopicDiscovery(const Participant& participant);

  /// Those of other participants that joined since the last call; does not wait.
  std::vector<FoundWriter> take();

 private:
  std::uint64_t own_participant_;
  Entity publications_;
};

}  // namespace slammot::dds
