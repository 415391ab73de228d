#include "services/slammot/collector.hpp"

#include <unistd.h>

#include "common/wire/localized_scan.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

constexpr auto kSilenceAtTheEnd = 2s;    ///< After the log's end: no more answers are under way.
constexpr auto kRepeatCommand = 500ms;

bool is_set(const wire::ServiceStatus& status, std::string_view counter) {
  for (const wire::Counter& one : status.counters) {
    if (one.name == counter) return one.total > 0;
  }
  return false;
}

}  // namespace

Collector::Collector(const CollectorOptions& options)
    : vehicle_id_(options.vehicle_id),
      participant_({options.domain_id, "slammot-collector", options.dds_config}),
      wait_set_(participant_),
      laser_scans_(participant_, dds::topics::kLaserScan, dds::History::kRecorder),
      localized_scans_(participant_, dds::topics::kLocalizedScan, dds::History::kRecorder),
      tracked_objects_(participant_, dds::topics::kTrackedObjects, dds::History::kRecorder),
      stored_tiles_(participant_, dds::topics::kStoredSubmapTile),
      constraints_(participant_, dds::topics::kConstraint),
      corrections_(participant_, dds::topics::kGraphCorrection),
      statuses_(participant_, dds::topics::kStatus),
      replies_(participant_, dds::topics::kReply),
      commands_(participant_, dds::topics::kCommand),
      requester_("collector-" + std::to_string(getpid())),
      last_progress_(Clock::now()) {
  read(laser_scans_, [this](const auto& sample) { take(sample); });
  read(localized_scans_, [this](const auto& sample) { take(sample); });
  read(tracked_objects_, [this](const auto& sample) { take(sample); });
  read(stored_tiles_, [this](const auto& sample) { take(sample); });
  read(constraints_, [this](const auto& sample) {
    if (const auto constraint = wire::decode(sample)) record_.add(*constraint);
  });
  read(corrections_, [this](const auto& sample) { take(sample); });
  read(statuses_, [this](const auto& sample) {
    auto status = wire::decode(sample);
    if (!status) return;
    if (status->name.service == "ingest" && is_set(*status, "log_finished")) is_log_finished_ = true;
    status_by_service_[status->name.service] = std::move(*status);
  });
  read(replies_, [this](const auto& sample) {
    if (wire::text(sample.requester) == requester_ && sample.result == slammot_OUTCOME_DONE) is_submap_finished_ = true;
  });
}

template <typename Sample, typename Handle>
void Collector::read(dds::Reader<Sample>& reader, Handle handle) {
  wait_set_.on_data(reader, [this, &reader, handle] {
    reader.take_each([&](const Sample& sample) {
      if (wire::is_about(sample, vehicle_id_)) handle(sample);
    });
  });
}

bool Collector::wait(std::chrono::milliseconds longest) { return wait_set_.wait(longest) != dds::WaitSet::Wake::kStopped; }

void Collector::take(const slammot_LaserScan& scan) {
  if (stamps_by_sequence_.emplace(scan.sequence_number, scan.stamp_ns).second) seen_at_[scan.stamp_ns] = Clock::now();
}

void Collector::take(const slammot_LocalizedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan) return;
  record_.add(*scan);
  last_localized_ns_ = std::max(scan->stamp_ns, last_localized_ns_.value_or(scan->stamp_ns));
  submap_in_use_ = std::max(scan->submap_id, submap_in_use_.value_or(scan->submap_id));
  last_progress_ = Clock::now();
}

void Collector::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!objects) return;
  record_.add(*objects);
  last_tracked_ns_ = std::max(objects->stamp_ns, last_tracked_ns_.value_or(objects->stamp_ns));
  last_progress_ = Clock::now();
  const auto seen = seen_at_.find(objects->stamp_ns);
  if (seen == seen_at_.end()) return;
  scan_to_tracks_.add(Clock::now() - seen->second);
  seen_at_.erase(seen_at_.begin(), std::next(seen));
}

void Collector::take(const slammot_SubmapTile& tile) {
  auto added = submap_assembler_.add(tile);
  if (added.submap) record_.add(std::move(*added.submap));
  last_progress_ = Clock::now();
}

void Collector::take(const slammot_GraphCorrection& part) {
  const auto added = correction_assembler_.add(part);
  if (!added.correction) return;
  record_.add(*added.correction);
  for (const flow::CorrectedSubmap& submap : added.correction->submaps) placed_submaps_.insert(submap.submap_id);
  last_progress_ = Clock::now();
}

bool Collector::has_drive_ended() const {
  if (!is_log_finished_) return false;
  const bool is_answered = !stamps_by_sequence_.empty() && last_tracked_ns_ && *last_tracked_ns_ >= stamps_by_sequence_.rbegin()->second;
  return is_answered || Clock::now() - last_progress_ > kSilenceAtTheEnd;
}

void Collector::ask_to_finish_submap() {
  wire::Command command;
  command.vehicle_id = vehicle_id_;
  command.service = "localization";
  command.requester = requester_;
  command.request_number = 1;  // the same each time: asked again, it is not done again
  command.verb = "finish_submap";
  commands_.write(wire::encode(command));
}

bool Collector::is_complete() const {
  return is_submap_finished_ && (!submap_in_use_ || (record_.submaps().contains(*submap_in_use_) && placed_submaps_.contains(*submap_in_use_)));
}

bool Collector::finish(std::chrono::seconds patience) {
  last_progress_ = Clock::now();
  auto ask_again_at = Clock::now();
  while (!is_complete()) {
    if (Clock::now() - last_progress_ > patience) return false;
    if (!is_submap_finished_ && Clock::now() >= ask_again_at) {
      ask_to_finish_submap();
      ask_again_at = Clock::now() + kRepeatCommand;
    }
    if (!wait(100ms)) return false;
  }
  wait(50ms);  // constraints and statuses that are still on their way
  return true;
}

std::vector<std::int64_t> Collector::scan_stamps_ns() const {
  std::vector<std::int64_t> stamps_ns;
  for (const auto& [sequence, stamp_ns] : stamps_by_sequence_) stamps_ns.push_back(stamp_ns);
  return stamps_ns;
}

files::RunRecord Collector::record(const std::vector<std::int64_t>& scan_stamps_ns) const {
  files::RunRecord record = record_;
  for (const std::int64_t stamp_ns : scan_stamps_ns) record.add_scan(stamp_ns);
  return record;
}

std::map<std::string, std::map<std::string, std::uint64_t>> Collector::counters() const {
  std::map<std::string, std::map<std::string, std::uint64_t>> counters;
  for (const auto& [service, status] : status_by_service_) {
    for (const wire::Counter& counter : status.counters) counters[service][counter.name] = counter.total;
  }
  return counters;
}

std::vector<files::StageLatency> Collector::latencies() const {
  std::vector<files::StageLatency> stages;
  for (const auto& [service, status] : status_by_service_) {
    for (const wire::StageLatency& stage : status.latencies) {
      stages.push_back({service + "." + stage.stage, stage.calls, stage.p50_ms, stage.p99_ms, stage.highest_ms});
    }
  }
  stages.push_back({"scan_to_tracks", scan_to_tracks_.count(), scan_to_tracks_.percentile_ms(0.5), scan_to_tracks_.percentile_ms(0.99),
                    scan_to_tracks_.highest_ms()});
  return stages;
}

}  // namespace slammot
