#include "common/dds/topic_table.hpp"

#include <algorithm>
#include <array>

namespace slammot::dds {

std::span<const TopicInfo* const> topic_table() {
  using namespace topics;
  static constexpr std::array<const TopicInfo*, 22> kTable = {&kLaserScan,
                                                              &kOdometry,
                                                              &kGnssFix,
                                                              &kCompassReading,
                                                              &kTruePose,
                                                              &kTrueObjects,
                                                              &kTrueHits,
                                                              &kLocalizedScan,
                                                              &kSegmentedScan,
                                                              &kTrackedObjects,
                                                              &kStoredTrackedObjects,
                                                              &kScanLabels,
                                                              &kCollisionWarnings,
                                                              &kSubmapTile,
                                                              &kStoredSubmapTile,
                                                              &kStoredMap,
                                                              &kConstraint,
                                                              &kGraphCorrection,
                                                              &kHeartbeat,
                                                              &kStatus,
                                                              &kCommand,
                                                              &kReply};
  return kTable;
}

bool has_one_writer(const TopicInfo& topic) {
  return topic.flow == Flow::kEstimate || topic.name == topics::kLaserScan.name;
}

const TopicInfo* find_topic(std::string_view name) {
  const auto table = topic_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const TopicInfo* topic) { return topic->name == name; });
  return row == table.end() ? nullptr : *row;
}

}  // namespace slammot::dds
