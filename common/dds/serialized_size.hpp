#pragma once

#include <cstddef>

#include "common/dds/topic_table.hpp"

namespace slammot::dds {

std::size_t serialized_sample_bytes(const TopicInfo& topic, const void* sample);

/// Bytes of this sample on the wire, its header left out. Throws Error when the sample breaks its
/// type's limits.
template <typename Sample>
std::size_t serialized_bytes(const Topic<Sample>& topic, const Sample& sample) {
  return serialized_sample_bytes(topic, &sample);
}

}  // namespace slammot::dds
