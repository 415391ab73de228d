#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace slammot::dds {

/// Quality-of-service profiles, for writers and readers.
enum class Flow {
  kSensor,     ///< Scans, odometry: late samples are useless.
  kEstimate,   ///< Localized scans, segments, tracks, labels.
  kTile,       ///< Tiles of maps, one key each: a late joiner receives all.
  kGraph,      ///< Constraints and corrections, keyed: a late joiner gets the last ones.
  kStatus,     ///< Keyed by service: a late joiner gets the last one.
  kHeartbeat,  ///< Liveliness asserted by writing.
  kCommand,    ///< Commands and replies: late samples are dropped.
};

enum class Durability { kVolatile, kTransientLocal };

/// Everything is reliable: best effort loses 12 % on a link that loses 5 %. Every history is
/// keep-last: with keep-all one stopped reader starves the others.
struct QosProfile {
  Durability durability = Durability::kVolatile;
  std::int32_t reader_depth = 1;   ///< Samples kept per key for a slow reader.
  std::int32_t writer_depth = 1;   ///< Samples kept per key for retransmission.
  std::int32_t restart_depth = 0;  ///< Samples kept per key for readers with History::kRestart,
                                   ///< also by these.
  std::chrono::milliseconds max_blocking{100};  ///< Longest time for which a write waits for slow
                                                ///< readers.
  std::optional<std::chrono::milliseconds> lifespan = std::nullopt;  ///< Older samples are dropped.
  /// Asserted by each write; automatic when not set.
  std::optional<std::chrono::milliseconds> manual_liveliness = std::nullopt;
};

QosProfile qos_profile(Flow flow);

/// Name of a QoS policy as the DDS specification numbers it: 11 is "reliability".
std::string qos_policy_name(std::uint32_t policy_id);

}  // namespace slammot::dds
