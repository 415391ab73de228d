#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/dds/entity.hpp"
#include "common/dds/participant.hpp"

namespace slammot::dds {

/// Quality of service of an endpoint, as far as it decides who talks to whom.
struct EndpointQos {
  enum class Durability { kVolatile, kTransientLocal, kTransient, kPersistent };
  enum class Liveliness { kAutomatic, kManualByParticipant, kManualByTopic };
  static constexpr std::int64_t kUnlimited = -1;

  bool is_reliable = false;
  Durability durability = Durability::kVolatile;
  std::int32_t depth = 1;  ///< 0: keeps all.
  Liveliness liveliness = Liveliness::kAutomatic;
  std::int64_t lease_ns = kUnlimited;  ///< Of liveliness.
  std::int64_t deadline_ns = kUnlimited;
  std::int64_t lifespan_ns = kUnlimited;  ///< Of a writer.
  bool is_exclusive = false;              ///< Ownership.
  bool is_by_source_time = false;         ///< Order of samples of several writers.
  std::vector<std::string> partitions;

  /// One line, such as "reliable, transient-local, keep-last 1, automatic".
  std::string text() const;
};

/// Why a writer and a reader of one topic are not connected, in words that say what to change;
/// empty if their QoS is compatible: DDS 1.4, 2.2.3, "requested / offered".
std::vector<std::string> incompatibilities(const EndpointQos& writer, const EndpointQos& reader);

/// A process on the bus.
struct Peer {
  std::string name;  ///< E.g. "slammot-localization"; the program's where the participant has none.
  std::string host;
  std::string process_number;  ///< Empty if unknown.
};

/// A writer or a reader of a topic.
struct RemoteEndpoint {
  using Guid = std::string;  ///< 32 hexadecimal digits.

  Guid guid;
  Guid participant;
  bool is_writer = false;
  std::string topic;
  std::string type;
  EndpointQos qos;
  std::vector<unsigned char> type_hash;  ///< Equal for equal types; empty if the type is not told.
};

/// Everybody who has been discovered on the bus, by the built-in topics. Not thread-safe.
class Discovery {
 public:
  explicit Discovery(const Participant& participant);
  ~Discovery();

  /// Takes what is new. Returns true if something has changed.
  bool update();
  /// Updates until nothing has changed for `quiet`, at most for `longest`.
  void settle(std::chrono::milliseconds quiet, std::chrono::milliseconds longest);

  /// Those of other participants.
  const std::map<RemoteEndpoint::Guid, RemoteEndpoint>& endpoints() const { return endpoints_; }
  const std::map<RemoteEndpoint::Guid, Peer>& peers() const { return peers_; }
  /// The peer of an endpoint; an empty one if it is unknown.
  Peer peer_of(const RemoteEndpoint& endpoint) const;

 private:
  bool take_participants();
  bool take_endpoints(Entity::Handle reader, bool are_writers);

  RemoteEndpoint::Guid own_;
  Entity participants_, publications_, subscriptions_;
  std::map<RemoteEndpoint::Guid, RemoteEndpoint> endpoints_;
  std::map<RemoteEndpoint::Guid, Peer> peers_;
};

}  // namespace slammot::dds
