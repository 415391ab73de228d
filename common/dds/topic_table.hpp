#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/dds/qos.hpp"
#include "idl/collision.h"
#include "idl/detection.h"
#include "idl/localization.h"
#include "idl/mapping.h"
#include "idl/sensor.h"
#include "idl/service.h"
#include "idl/tracking.h"
#include "idl/truth.h"

namespace slammot::dds {

enum class Recorded { kNo, kYes };

struct TopicInfo {
  std::string_view name;
  const dds_topic_descriptor* type;  ///< The C library's, as idlc generated it.
  Flow flow;
  Recorded recorded;  ///< Default choice of the recorder.
  /// Services that may publish it, separated by spaces; "*": every service. `tools` is the command
  /// line.
  std::string_view publishers = {};
  /// Bytes after which all appendable structures in the sample have begun. Cyclone DDS 0.10.2 calls
  /// abort() where it reads a sample that ends before one. 0: the type has none, but in sequences.
  std::uint32_t least_bytes = 0;

  std::string_view type_name() const { return type->m_typename; }
};

/// Longest keys of a SubmapTile, and the delimiter of its header.
constexpr std::uint32_t kLeastBytesOfTile = 52;

/// A row of the topic table that knows its type.
template <typename Sample>
struct Topic : TopicInfo {};

namespace topics {

inline constexpr Topic<slammot_LaserScan> kLaserScan{{"slammot/laser_scan", &slammot_LaserScan_desc,
                                                      Flow::kSensor, Recorded::kYes,
                                                      "ingest simulator"}};
inline constexpr Topic<slammot_Odometry> kOdometry{{"slammot/odometry", &slammot_Odometry_desc,
                                                    Flow::kSensor, Recorded::kYes,
                                                    "ingest simulator"}};
inline constexpr Topic<slammot_GnssFix> kGnssFix{
    {"slammot/gnss_fix", &slammot_GnssFix_desc, Flow::kSensor, Recorded::kYes, "ingest simulator"}};
inline constexpr Topic<slammot_CompassReading> kCompassReading{
    {"slammot/compass_reading", &slammot_CompassReading_desc, Flow::kSensor, Recorded::kYes,
     "ingest simulator"}};
inline constexpr Topic<slammot_TruePose> kTruePose{
    {"slammot/true_pose", &slammot_TruePose_desc, Flow::kSensor, Recorded::kYes, "simulator"}};
inline constexpr Topic<slammot_TrueObjects> kTrueObjects{{"slammot/true_objects",
                                                          &slammot_TrueObjects_desc, Flow::kSensor,
                                                          Recorded::kYes, "simulator"}};
inline constexpr Topic<slammot_TrueHits> kTrueHits{
    {"slammot/true_hits", &slammot_TrueHits_desc, Flow::kSensor, Recorded::kYes, "simulator"}};
inline constexpr Topic<slammot_LocalizedScan> kLocalizedScan{
    {"slammot/localized_scan", &slammot_LocalizedScan_desc, Flow::kEstimate, Recorded::kYes,
     "localization"}};
inline constexpr Topic<slammot_SegmentedScan> kSegmentedScan{
    {"slammot/segmented_scan", &slammot_SegmentedScan_desc, Flow::kEstimate, Recorded::kNo,
     "detection"}};
inline constexpr Topic<slammot_TrackedObjects> kTrackedObjects{
    {"slammot/tracked_objects", &slammot_TrackedObjects_desc, Flow::kEstimate, Recorded::kYes,
     "tracking"}};
inline constexpr Topic<slammot_TrackedObjects> kStoredTrackedObjects{
    {"slammot/stored_tracked_objects", &slammot_TrackedObjects_desc, Flow::kGraph, Recorded::kNo,
     "map_store"}};
inline constexpr Topic<slammot_ScanLabels> kScanLabels{
    {"slammot/scan_labels", &slammot_ScanLabels_desc, Flow::kEstimate, Recorded::kNo, "tracking"}};
inline constexpr Topic<slammot_CollisionWarnings> kCollisionWarnings{
    {"slammot/collision_warnings", &slammot_CollisionWarnings_desc, Flow::kEstimate, Recorded::kYes,
     "collision_warning"}};
inline constexpr Topic<slammot_SubmapTile> kSubmapTile{
    {"slammot/submap_tile", &slammot_SubmapTile_desc, Flow::kTile, Recorded::kNo, "localization",
     kLeastBytesOfTile}};
inline constexpr Topic<slammot_SubmapTile> kStoredSubmapTile{
    {"slammot/stored_submap_tile", &slammot_SubmapTile_desc, Flow::kTile, Recorded::kYes,
     "map_store", kLeastBytesOfTile}};
inline constexpr Topic<slammot_StoredMap> kStoredMap{
    {"slammot/stored_map", &slammot_StoredMap_desc, Flow::kGraph, Recorded::kNo, "map_store"}};
inline constexpr Topic<slammot_Constraint> kConstraint{
    {"slammot/constraint", &slammot_Constraint_desc, Flow::kGraph, Recorded::kYes, "loop_closing"}};
inline constexpr Topic<slammot_GraphCorrection> kGraphCorrection{
    {"slammot/graph_correction", &slammot_GraphCorrection_desc, Flow::kGraph, Recorded::kYes,
     "loop_closing"}};
inline constexpr Topic<slammot_TrafficWays> kTrafficWays{
    {"slammot/traffic_ways", &slammot_TrafficWays_desc, Flow::kGraph, Recorded::kYes, "map_store"}};
inline constexpr Topic<slammot_Heartbeat> kHeartbeat{
    {"slammot/heartbeat", &slammot_Heartbeat_desc, Flow::kHeartbeat, Recorded::kNo, "*"}};
inline constexpr Topic<slammot_ServiceStatus> kStatus{
    {"slammot/status", &slammot_ServiceStatus_desc, Flow::kStatus, Recorded::kYes, "*"}};
inline constexpr Topic<slammot_Command> kCommand{
    {"slammot/command", &slammot_Command_desc, Flow::kCommand, Recorded::kYes, "gateway tools"}};
inline constexpr Topic<slammot_Reply> kReply{
    {"slammot/reply", &slammot_Reply_desc, Flow::kCommand, Recorded::kYes, "*"}};

}  // namespace topics

/// All topics; idl/README.md describes each.
std::span<const TopicInfo* const> topic_table();

/// True if each key of the topic has one writer at a time: a second one is another process that
/// takes itself for the source, or somebody who lies.
bool has_one_writer(const TopicInfo& topic);

/// True if the service, e.g. "map_store", is among the topic's publishers.
bool may_publish(std::string_view service, const TopicInfo& topic);

/// All names among the publishers, sorted, without "*".
std::vector<std::string_view> publishing_services();

/// Row of that name; null if there is none.
const TopicInfo* find_topic(std::string_view name);

/// True if its writers keep samples for restarts of their readers, and for nobody else: to others
/// it is volatile.
bool is_kept_for_restarts_only(std::string_view name);

}  // namespace slammot::dds
