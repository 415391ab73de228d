#include "services/tracking/tracking_journal.hpp"

#include <utility>

#include "services/tracking/state_parts.hpp"

namespace slammot::tracking {
namespace {

struct SessionParts : StateParts {
  /// All others.
  static void visit(auto& to, auto& value) { StateParts::visit(to, value); }

  static void visit(auto& to, memory::Like<DriveFrame> auto& frame) {
    auto& [map_id, odom_id] = frame;
    to(map_id, odom_id);
  }
  static void visit(auto& to, memory::Like<geometry::Pose2> auto& pose) {
    auto& [x_m, y_m, heading_rad] = pose;
    to(x_m, y_m, heading_rad);
  }
  static void visit(auto& to, memory::Like<flow::PredictedPosition> auto& position) {
    auto& [after_s, position_in_odom_m, covariance_m2] = position;
    to(after_s, position_in_odom_m, covariance_m2);
  }
  static void visit(auto& to, memory::Like<flow::TrackedObjects> auto& objects) {
    auto& [stamp_ns, sequence, map_from_odom, odom_from_base, all, map_id, odom_id] = objects;
    to(stamp_ns, sequence, map_from_odom, odom_from_base, all, map_id, odom_id);
  }
  static void visit(auto& to, memory::Like<flow::ScanLabels> auto& labels) {
    auto& [stamp_ns, sequence, scanner_id, of_beams, restored] = labels;
    to(stamp_ns, sequence, scanner_id, of_beams, restored);
  }
  static void visit(auto& to, memory::Like<TrackingResult> auto& result) {
    auto& [objects, labels] = result;
    to(objects, labels);
  }
  static void visit(auto& to, memory::Like<Session> auto& session) {
    auto& [frame, last_results] = session;
    to(frame, last_results);
  }
};

}  // namespace

std::vector<std::byte> to_bytes(const Session& session, const Tracker& tracker) {
  std::vector<std::byte> bytes;
  save_state<SessionParts>(bytes, session);
  tracker.save(bytes);
  memory::put(bytes, memory::checksum(bytes));
  return bytes;
}

std::optional<Session> restore(std::span<const std::byte> bytes, Tracker& tracker) {
  const auto content = memory::unsealed(bytes);
  if (!content) return std::nullopt;
  memory::ByteReader from(*content);
  Session session;
  load_state<SessionParts>(from, session);
  if (!from.ok() || !tracker.restore(content->last(from.left()))) return std::nullopt;
  return session;
}

}  // namespace slammot::tracking
