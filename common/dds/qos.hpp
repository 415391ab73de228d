#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::dds {

/// Kinds of flow that share one quality of service, for writers and readers alike.
enum class Flow {
  kSensor,     ///< Scans, odometry: what was missed is of no use later.
  kEstimate,   ///< Localized scans, segments, tracks, labels.
  kTile,       ///< Pieces of maps, each its own key: a late joiner gets all of them.
  kGraph,      ///< Constraints and corrections, keyed: a late joiner gets the last ones.
  kStatus,     ///< Keyed by service: a late joiner gets the last one.
  kHeartbeat,  ///< Liveliness asserted by writing.
  kCommand,    ///< Commands and replies; too late is not at all.
};

enum class Durability { kVolatile, kTransientLocal };

/// Everything is reliable: best effort loses 12 % where the link loses 5 %. Everything keeps the last few, never all:
/// with keep-all one stopped reader starves the others.
struct QosProfile {
  Durability durability = Durability::kVolatile;
  std::int32_t reader_depth = 1;                ///< Samples kept per key for a reader that is late.
  std::int32_t writer_depth = 1;                ///< Samples kept per key to be sent again where the link lost them.
  std::chrono::milliseconds max_blocking{100};  ///< A write waits so long for slow readers.
  std::optional<std::chrono::milliseconds> lifespan = std::nullopt;  ///< Older samples are dropped.
  /// Asserted by each write; automatic when not set.
  std::optional<std::chrono::milliseconds> manual_liveliness = std::nullopt;
};

QosProfile qos_profile(Flow flow);

/// Name of a QoS policy as the DDS specification numbers it: 11 is "reliability".
std::string qos_policy_name(std::uint32_t policy_id);

}  // namespace slammot::dds
