#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/dds/offered_qos.hpp"
#include "common/dds/raw_topic.hpp"
#include "common/mcap/file.hpp"

namespace slammot::recordings {

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
std::optional<PlayableTopic> playable(const mcap::Contents& contents, const mcap::Channel& channel);

/// The vehicle of a sample: its id is the first key of every topic. Empty if there is none.
std::string vehicle_of(const dds::TypeModel& model, std::span<const std::uint8_t> cdr);

/// The vehicle of the first sample that has one, heartbeats and status (of the recorder, too)
/// apart; empty if none has.
std::string first_vehicle(const mcap::File& file);

}  // namespace slammot::recordings
