#pragma once

#include <memory>
#include <optional>

#include "common/dds/offered_qos.hpp"
#include "common/dds/raw_topic.hpp"
#include "common/mcap/records.hpp"

namespace slammot::recorder {

/// A topic as a recording describes it. The schema is OMG IDL, for people and for other programs;
/// the description that travels on the bus and the writer's QoS are metadata of the channel, so
/// that the topic can be played without its type being compiled in.
struct RecordedTopic {
  mcap::Schema schema;    ///< Its id is not set.
  mcap::Channel channel;  ///< Neither.
};

RecordedTopic describe(const dds::RawTopic& topic, const dds::OfferedQos& qos);

struct PlayableTopic {
  std::shared_ptr<const dds::RawTopic> topic;
  dds::OfferedQos qos;
};

/// None for a channel that was recorded otherwise, or is damaged.
std::optional<PlayableTopic> playable(const mcap::Channel& channel, const mcap::Schema* schema);

}  // namespace slammot::recorder
