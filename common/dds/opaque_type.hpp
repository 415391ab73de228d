#pragma once

#include <memory>

#include "common/dds/entity.hpp"
#include "common/dds/offered_qos.hpp"
#include "common/dds/raw_topic.hpp"

struct ddsi_sertype;

namespace slammot::dds {

/// What tells instances apart.
enum class Instances : std::uint8_t {
  kOne,    ///< Nothing: samples come in the order in which they arrived, whatever their keys.
  kByKey,  ///< Their keys.
};

/// A topic whose samples are bytes that the library neither reads nor makes, and which is announced
/// with the type's own description, so that it matches what is compiled. Its QoS is that of a
/// compiled topic of the same name: a participant has one QoS for all topics of one name.
struct OpaqueTopic {
  Entity entity;
  const ddsi_sertype* type = nullptr;  ///< Lives as long as the entity.
};

OpaqueTopic create_opaque_topic(const Participant& participant,
                                std::shared_ptr<const RawTopic> topic, const OfferedQos& offered,
                                Instances instances);

}  // namespace slammot::dds
