#include "services/loop_closing/loop_closing_service.hpp"

#include <spdlog/spdlog.h>

#include "services/loop_closing/loop_closing_fields.hpp"

namespace slammot::loop_closing {

std::vector<config::BoundStage> LoopClosingService::stages(Settings& settings) {
  return {config::bind_stage("loop_closing", loop_closing_fields(), settings.config)};
}

LoopClosingService::LoopClosingService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      config_(settings.config),
      closer_(settings.config),
      constraints_(context.write(dds::topics::kConstraint)),
      corrections_(context.write(dds::topics::kGraphCorrection)) {
  context.read(dds::topics::kStoredSubmapTile, app::Input::kOccasional, [this](const auto& tile) { take(tile); });
}

void LoopClosingService::take(const slammot_SubmapTile& tile) {
  auto assembled = assembler_.add(tile);
  if (!assembled.fault.empty()) context_.warn("faulty_tiles", "dropped a submap tile: " + std::string(assembled.fault));
  if (!assembled.submap) return;
  if (is_of_another_drive(*assembled.submap)) begin_again();
  waiting_[assembled.submap->submap_id] = std::move(*assembled.submap);
  add_waiting();
}

/// A submap that is done again after a restart of localization overlaps its first version in time.
bool LoopClosingService::is_of_another_drive(const flow::Submap& submap) const {
  if (submap.submap_id.value >= added_.size()) return false;
  const TimeSpan& known = added_[submap.submap_id.value];
  return submap.first_stamp_ns > known.last_ns || submap.last_stamp_ns < known.first_ns;
}

void LoopClosingService::begin_again() {
  spdlog::info("a new drive: forgets {} submaps", added_.size());
  for (const flow::Constraint& constraint : closer_.constraints()) constraints_.end(wire::encode(context_.vehicle_id(), constraint));
  closer_ = LoopCloser(config_);
  added_.clear();
  published_constraints_ = 0;
}

/// In ascending order, without gaps: each is bound to the one before it.
void LoopClosingService::add_waiting() {
  std::erase_if(waiting_, [this](const auto& waiting) { return waiting.first.value < added_.size(); });
  for (auto next = waiting_.begin(); next != waiting_.end() && next->first.value == added_.size(); next = waiting_.erase(next)) {
    add(next->second);
  }
  if (waiting_.empty()) {
    context_.status().clear_trouble("gap");
  } else {
    context_.status().set_trouble("gap", "waits for submap " + std::to_string(added_.size()));
  }
}

void LoopClosingService::add(const flow::Submap& submap) {
  const app::Stopwatch stopwatch(context_.status().latency("add_submap"));
  const flow::GraphCorrection correction = closer_.add(submap);
  added_.push_back({submap.first_stamp_ns, submap.last_stamp_ns});
  publish_new_constraints();
  correction_encoder_.encode(context_.vehicle_id(), correction, [this](const auto& part) { corrections_.write(part); });
  context_.status().set_counters(named(closer_.counters()));
}

/// Constraints are only ever added at the end.
void LoopClosingService::publish_new_constraints() {
  const std::vector<flow::Constraint>& all = closer_.constraints();
  for (; published_constraints_ < all.size(); ++published_constraints_) {
    constraints_.write(wire::encode(context_.vehicle_id(), all[published_constraints_]));
  }
}

}  // namespace slammot::loop_closing
