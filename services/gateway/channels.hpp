#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace slammot::gateway {

/// What viewers can subscribe to, in the order of channels().
enum class ChannelId : std::uint32_t {
  kScan,
  kPoints,
  kTracks,
  kPose,
  kTrajectory,
  kTransforms,
  kStationaryMap,
  kMovingMap,
  kWays,
  kFix,
  kLog,
  kTrackDetails,
  kPoseDetails,
  kGraph,
  kWayDetails,
  kHealth,
};

/// kLast: the last message is sent to whoever subscribes later. kLastWanted: so it is, but messages
/// are made only while somebody subscribes, since they are costly.
enum class Retention { kNone, kLast, kLastWanted };

struct Channel {
  ChannelId id{};
  std::string topic;
  std::string encoding;     ///< "protobuf" or "json".
  std::string schema_name;  ///< "foxglove.LaserScan".
  std::string schema;       ///< Serialized FileDescriptorSet in base64, or a JSON schema.
  Retention retention = Retention::kNone;

  std::string schema_encoding() const { return encoding == "json" ? "jsonschema" : encoding; }
};

/// All channels; the index is the id.
const std::vector<Channel>& channels();
inline constexpr std::size_t kChannelCount = 16;

}  // namespace slammot::gateway
