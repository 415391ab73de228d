#include "services/slammot/replay_plan.hpp"

#include <algorithm>

#include "common/dds/topic_table.hpp"

namespace slammot {
namespace {

namespace topics = dds::topics;

using Infos = std::vector<const dds::TopicInfo*>;

std::vector<std::string> names(const Infos& infos) {
  std::vector<std::string> names;
  for (const dds::TopicInfo* info : infos) names.emplace_back(info->name);
  return names;
}

/// The first input is the trigger. Every service also answers commands.
ReplayPlan plan(const char* service, Infos inputs, const Infos& outputs) {
  const std::string trigger(inputs.front()->name);
  inputs.push_back(&topics::kCommand);
  return {service, trigger, names(inputs), names(outputs)};
}

const std::vector<ReplayPlan>& plans() {
  static const std::vector<ReplayPlan> kPlans = {
      plan("detection", {&topics::kLocalizedScan}, {&topics::kSegmentedScan}),
      plan("localization",
           {&topics::kLaserScan, &topics::kOdometry, &topics::kSegmentedScan,
            &topics::kTrackedObjects, &topics::kScanLabels, &topics::kGraphCorrection,
            &topics::kStoredMap},
           {&topics::kLocalizedScan, &topics::kSubmapTile}),
      plan("loop_closing", {&topics::kStoredSubmapTile},
           {&topics::kGraphCorrection, &topics::kConstraint}),
      // stored_tracked_objects is a relay: which samples it leaves out depends on timing, and so
      // does how often traffic_ways are found
      plan("map_store", {&topics::kSubmapTile}, {&topics::kStoredMap, &topics::kStoredSubmapTile}),
      plan("tracking", {&topics::kSegmentedScan, &topics::kStoredTrackedObjects},
           {&topics::kTrackedObjects, &topics::kScanLabels})};
  return kPlans;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

bool ReplayPlan::is_input(const std::string& topic) const { return contains(inputs, topic); }
bool ReplayPlan::is_output(const std::string& topic) const { return contains(outputs, topic); }

std::optional<ReplayPlan> replay_plan(std::string service) {
  std::ranges::replace(service, '-', '_');
  const auto plan = std::ranges::find(plans(), service, &ReplayPlan::service);
  return plan == plans().end() ? std::nullopt : std::optional(*plan);
}

std::string replayed_services() {
  std::string names;
  for (const ReplayPlan& plan : plans()) names += (names.empty() ? "" : ", ") + plan.service;
  return names;
}

}  // namespace slammot
