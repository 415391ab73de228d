#include "common/dds/topic_table.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace slammot::dds {
namespace {

std::set<std::string_view> words_of(std::string_view text) {
  std::set<std::string_view> words;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    words.insert(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return words;
}

}  // namespace

std::span<const TopicInfo* const> topic_table() {
  using namespace topics;
  static constexpr std::array<const TopicInfo*, 23> kTable = {&kLaserScan,
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
                                                              &kTrafficWays,
                                                              &kHeartbeat,
                                                              &kStatus,
                                                              &kCommand,
                                                              &kReply};
  return kTable;
}

bool has_one_writer(const TopicInfo& topic) {
  return topic.flow == Flow::kEstimate || topic.name == topics::kLaserScan.name;
}

bool may_publish(std::string_view service, const TopicInfo& topic) {
  return topic.publishers == "*" || words_of(topic.publishers).contains(service);
}

std::vector<std::string_view> publishing_services() {
  std::set<std::string_view> services;
  for (const TopicInfo* topic : topic_table()) services.merge(words_of(topic->publishers));
  services.erase("*");
  return {services.begin(), services.end()};
}

const TopicInfo* find_topic(std::string_view name) {
  const auto table = topic_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const TopicInfo* topic) { return topic->name == name; });
  return row == table.end() ? nullptr : *row;
}

bool is_kept_for_restarts_only(std::string_view name) {
  const TopicInfo* const topic = find_topic(name);
  return topic != nullptr && qos_profile(topic->flow).restart_depth > 0;
}

}  // namespace slammot::dds
