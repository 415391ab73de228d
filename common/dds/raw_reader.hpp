#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "common/dds/offered_qos.hpp"
#include "common/dds/raw_topic.hpp"
#include "common/dds/reader.hpp"

namespace slammot::dds {

/// A sample as it travels.
struct RawSample {
  std::span<const std::uint8_t> cdr;  ///< With its header of 4 bytes (OMG
                                      ///< DDS-XTypes 1.3, 7.6.3.1.2).
  std::int64_t source_time_ns = 0;    ///< The writer's system clock when it wrote.
};

/// Reads the samples of a topic without knowing its type when compiled. Keeps the last 10,000 until
/// they are taken. Not thread-safe.
class RawReader : public ReaderBase {
 public:
  /// Requests what the writer offers, so that the two match.
  RawReader(const Participant& participant, std::shared_ptr<const RawTopic> topic,
            const OfferedQos& offered);

  const RawTopic& raw_topic() const { return *raw_topic_; }

  /// Calls `handle` for every unread sample with a value, in the order in which they arrived. The
  /// bytes are valid during the call. Returns their number.
  std::size_t take_each(const std::function<void(const RawSample&)>& handle);

 private:
  std::shared_ptr<const RawTopic> raw_topic_;
};

}  // namespace slammot::dds
