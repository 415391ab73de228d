#include "services/gateway/drive_messages.hpp"

#include <utility>

#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/gateway/other_messages.hpp"
#include "services/gateway/pose_messages.hpp"
#include "services/gateway/scan_messages.hpp"
#include "services/gateway/track_messages.hpp"

namespace slammot::gateway {

DriveMessages::DriveMessages(Audience& audience, Warn warn)
    : audience_(audience),
      warn_(std::move(warn)),
      pairing_([this](const flow::LocalizedScan& scan, const auto& labels) {
        if (audience_.is_wanted(ChannelId::kPoints))
          audience_.publish(ChannelId::kPoints, scan.stamp_ns,
                            labelled_points_message(scan, labels).SerializeAsString());
      }),
      map_(audience) {}

template <typename Value>
bool DriveMessages::accept(const wire::Decoded<Value>& decoded, const char* counter) {
  if (!decoded) warn_(counter, "dropped a sample: " + std::string(decoded.fault()));
  return static_cast<bool>(decoded);
}

void DriveMessages::take(const slammot_LaserScan& sample) {
  if (!audience_.is_wanted(ChannelId::kScan)) return;
  const auto scan = wire::decode(sample);
  if (accept(scan, "faulty_scans"))
    audience_.publish(ChannelId::kScan, scan->stamp_ns,
                      laser_scan_message(*scan).SerializeAsString());
}

bool DriveMessages::take(const slammot_LocalizedScan& sample) {
  auto scan = wire::decode(sample);
  if (!accept(scan, "faulty_localized_scans")) return false;
  map_.follow(*scan);
  const auto publish = [&](ChannelId channel, const auto& message_of) {
    if (audience_.is_wanted(channel)) audience_.publish(channel, scan->stamp_ns, message_of());
  };
  publish(ChannelId::kPose, [&] { return pose_message(*scan).SerializeAsString(); });
  publish(ChannelId::kTransforms, [&] { return transforms_message(*scan).SerializeAsString(); });
  publish(ChannelId::kPoseDetails, [&] { return pose_json(*scan); });
  pairing_.take(std::move(*scan));
  return true;
}

void DriveMessages::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (accept(labels, "faulty_scan_labels")) pairing_.take(*labels);
}

void DriveMessages::take(const slammot_TrackedObjects& sample) {
  const bool wants_scene = audience_.is_wanted(ChannelId::kTracks);
  const bool wants_details = audience_.is_wanted(ChannelId::kTrackDetails);
  if (!wants_scene && !wants_details) return;
  const auto objects = wire::decode(sample);
  if (!accept(objects, "faulty_tracks")) return;
  if (wants_scene)
    audience_.publish(ChannelId::kTracks, objects->stamp_ns,
                      scene_message(*objects, shown_tracks_).SerializeAsString());
  shown_tracks_ = drawn_tracks(*objects);
  if (wants_details)
    audience_.publish(ChannelId::kTrackDetails, objects->stamp_ns, tracks_json(*objects));
}

void DriveMessages::take(const slammot_GnssFix& sample) {
  if (!audience_.is_wanted(ChannelId::kFix)) return;
  const auto fix = wire::decode(sample);
  if (accept(fix, "faulty_fixes"))
    audience_.publish(ChannelId::kFix, fix->stamp_ns, fix_message(*fix).SerializeAsString());
}

void DriveMessages::note_fault(const char* counter, std::string_view fault) {
  if (!fault.empty()) warn_(counter, "dropped a part of the map: " + std::string(fault));
}

void DriveMessages::take(const slammot_SubmapTile& tile) {
  note_fault("faulty_tiles", map_.take(tile));
}

void DriveMessages::take(const slammot_GraphCorrection& part) {
  note_fault("faulty_corrections", map_.take(part));
}

void DriveMessages::take(const slammot_TrafficWays& part) {
  note_fault("faulty_ways", map_.take(part));
}

void DriveMessages::take(const slammot_Constraint& sample) {
  const auto constraint = wire::decode(sample);
  if (accept(constraint, "faulty_constraints")) map_.take(*constraint);
}

}  // namespace slammot::gateway
