#pragma once

#include <memory>

#include "common/dds/offered_qos.hpp"
#include "common/dds/opaque_type.hpp"
#include "common/dds/raw_reader.hpp"
#include "common/dds/writer.hpp"

namespace slammot::dds {

enum class RawWriteResult {
  kWritten,
  kTimedOut,   ///< As WriteResult::kTimedOut.
  kMalformed,  ///< The sample's key cannot be read, or it is too short: nothing was sent.
};

/// Writes samples of a topic without knowing its type when compiled. Not thread-safe.
class RawWriter : public WriterBase {
 public:
  RawWriter(const Participant& participant, std::shared_ptr<const RawTopic> topic,
            const OfferedQos& offered);

  /// Writes the bytes as they are, with the sample's own source time. Throws Error on a failure of
  /// the bus.
  RawWriteResult write(const RawSample& sample);

 private:
  RawWriter(const Participant& participant, std::shared_ptr<const RawTopic> topic,
            OpaqueTopic opaque, const OfferedQos& offered);

  std::shared_ptr<const RawTopic> raw_topic_;
  const ddsi_sertype* type_;  ///< Lives as long as the topic.
};

}  // namespace slammot::dds
