#include "services/loop_closing/loop_closing_service.hpp"

#include <utility>

#include "common/app/log.hpp"
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
  context.read(dds::topics::kStoredSubmapTile, app::Input::kOccasional,
               [this](const auto& tile) { take(tile); });
  context.before_report([this] {
    finish_when_idle();
    context_.status().set_counters(named(closer_.counters()));
  });
}

void LoopClosingService::take(const slammot_SubmapTile& tile) {
  auto assembled = assembler_.add(tile);
  if (!assembled.fault.empty())
    context_.warn("faulty_tiles", "dropped a submap tile: " + std::string(assembled.fault));
  if (!assembled.submap) return;
  if (map_id_ != assembled.submap->map_id) begin_map(assembled.submap->map_id);
  waiting_[assembled.submap->submap_id] = std::move(*assembled.submap);
  add_waiting();
}

void LoopClosingService::begin_map(flow::MapId map_id) {
  if (map_id_) app::log_info("new map: discards {} submaps", added_);
  for (const flow::Constraint& constraint : closer_.constraints())
    constraints_.end(wire::encode(context_.vehicle_id(), constraint));
  closer_ = LoopCloser(config_);
  waiting_.clear();
  added_ = 0;
  published_states_.clear();
  map_id_ = map_id;
}

/// Adds submaps in ascending order without gaps, since each is constrained to the one before.
void LoopClosingService::add_waiting() {
  std::erase_if(waiting_, [this](const auto& waiting) { return waiting.first.value < added_; });
  for (auto next = waiting_.begin(); next != waiting_.end() && next->first.value == added_;
       next = waiting_.erase(next)) {
    add(next->second);
  }
  if (waiting_.empty()) {
    context_.status().clear_trouble("gap");
  } else {
    context_.status().set_trouble("gap", "waits for submap " + std::to_string(added_));
  }
}

void LoopClosingService::add(const flow::Submap& submap) {
  const app::Stopwatch stopwatch(context_.status().latency("add_submap"));
  const bool was_connected = closer_.is_connected();
  flow::GraphCorrection correction = closer_.add(submap);
  report_connection(submap.submap_id, was_connected);
  ++added_;
  reports_since_submap_ = 0;
  publish(std::move(correction));
}

void LoopClosingService::publish(flow::GraphCorrection correction) {
  correction.map_id = *map_id_;
  publish_new_constraints();
  correction_encoder_.encode(context_.vehicle_id(), correction,
                             [this](const auto& part) { corrections_.write(part); });
}

/// The drive may be over if no submap arrives: publishes the result of the pending searches.
void LoopClosingService::finish_when_idle() {
  constexpr int kIdleReports = 3;
  if (++reports_since_submap_ != kIdleReports || !closer_.has_unfinished_work()) return;
  publish(closer_.finish());
}

void LoopClosingService::report_connection(flow::SubmapId newest, bool was_connected) {
  const bool knows = closer_.is_connected();
  if (!knows && was_connected)
    app::log_warn("submap {} is not connected to the first one: searches for it on all islands",
                  newest.value);
  if (knows && !was_connected) app::log_info("located submap {}", newest.value);
  if (knows) context_.status().clear_trouble("astray");
  else
    context_.status().set_trouble(
        "astray", "submap " + std::to_string(newest.value) + " is not connected to the first one");
}

/// Publishes new constraints and closures whose state has changed.
void LoopClosingService::publish_new_constraints() {
  for (flow::Constraint& constraint : closer_.constraints()) {
    const auto [published, is_new] = published_states_.try_emplace(
        {constraint.from, constraint.to, constraint.kind}, constraint.verdict.state);
    if (!is_new && published->second == constraint.verdict.state) continue;
    published->second = constraint.verdict.state;
    constraint.map_id = *map_id_;
    constraints_.write(wire::encode(context_.vehicle_id(), constraint));
  }
}

}  // namespace slammot::loop_closing
