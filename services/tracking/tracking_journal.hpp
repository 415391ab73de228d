#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "services/tracking/tracker.hpp"

namespace slammot::tracking {

/// Identity of the odom frame in which objects are tracked.
struct DriveFrame {
  flow::MapId map_id;
  flow::OdomId odom_id;
  bool operator==(const DriveFrame&) const = default;
};

/// What tracking goes on from after a crash, beside the tracker.
struct Session {
  DriveFrame frame;
  std::map<std::string, TrackingResult> last_results;  ///< By scanner: the answer to a scan that is
                                                       ///< sent again.
};

/// With a checksum.
std::vector<std::byte> to_bytes(const Session& session, const Tracker& tracker);

/// The tracker takes up the state that the bytes hold. None, and it stays as it is, for bytes that
/// are damaged or of another version.
std::optional<Session> restore(std::span<const std::byte> bytes, Tracker& tracker);

}  // namespace slammot::tracking
