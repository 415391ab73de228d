#include "services/slammot/collector.hpp"

#include <unistd.h>

#include <algorithm>
#include <memory>

#include "common/app/owner_watch.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/text.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/localization/localization_service_clock.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

constexpr auto kFinalSilence = 2s;  ///< Silence after the end of the log that means that no more
                                    ///< tracks will come.
constexpr auto kRepeatCommand = 500ms;
constexpr auto kIngestTimeout = 30s;  ///< Time without a heartbeat of ingest after which a drive
                                      ///< restored from a journal has ended.

/// More than the 200 scans of the bus's history can hold, unless drives are shorter than a second.
constexpr std::size_t kEndedDrives = 16;

/// Unique over restarts in containers, where each process has the same id.
std::string unique_name() {
  return "collector-" + std::to_string(getpid()) + "-" +
         std::to_string(std::chrono::system_clock::now().time_since_epoch().count());
}

/// True for services that publish scans.
bool is_source(std::string_view service) { return service == "ingest" || service == "simulator"; }

/// A restarted collector also takes what was published while it was down.
dds::History history_after(const std::optional<files::RunJournal::Content>& restored) {
  return restored ? dds::History::kRestartedRecorder : dds::History::kRecorder;
}

bool is_set(const wire::ServiceStatus& status, std::string_view counter) {
  for (const wire::Counter& one : status.counters) {
    if (one.name == counter) return one.total > 0;
  }
  return false;
}

}  // namespace

Collector::Collector(const CollectorOptions& options)
    : vehicle_id_(options.vehicle_id),
      restored_(files::RunJournal::read(options.journal)),
      participant_({options.domain_id, "slammot-collector", options.dds_config}),
      wait_set_(participant_),
      laser_scans_(participant_, dds::topics::kLaserScan, dds::History::kRecorder),
      localized_scans_(participant_, dds::topics::kLocalizedScan, history_after(restored_)),
      tracked_objects_(participant_, dds::topics::kTrackedObjects, history_after(restored_)),
      segmented_scans_(participant_, dds::topics::kSegmentedScan, history_after(restored_)),
      scan_labels_(participant_, dds::topics::kScanLabels, dds::History::kRecorder),
      stored_tiles_(participant_, dds::topics::kStoredSubmapTile),
      constraints_(participant_, dds::topics::kConstraint),
      corrections_(participant_, dds::topics::kGraphCorrection),
      statuses_(participant_, dds::topics::kStatus),
      heartbeats_(participant_, dds::topics::kHeartbeat),
      replies_(participant_, dds::topics::kReply),
      commands_(participant_, dds::topics::kCommand),
      last_ingest_(Clock::now()),
      requester_(unique_name()),
      last_progress_(Clock::now()) {
  if (!options.journal.empty()) journal_.emplace(options.journal);
  if (restored_) restore(*restored_);
  restored_.reset();
  read(laser_scans_, [this](const auto& sample) { take(sample); });
  read(localized_scans_, [this](const auto& sample) { take(sample); });
  read(tracked_objects_, [this](const auto& sample) { take(sample); });
  read(segmented_scans_, [this](const auto& sample) {
    const auto scan = wire::decode(sample);
    if (scan && !has_ended({scan->map_id, scan->odom_id})) records_[scan->map_id].add(*scan);
  });
  read(scan_labels_, [this](const auto& sample) {
    const auto labels = wire::decode(sample);
    if (labels && drive_) records_[drive_->map_id].add(*labels);
  });
  read(stored_tiles_, [this](const auto& sample) { take(sample); });
  read(constraints_, [this](const auto& sample) {
    if (const auto constraint = wire::decode(sample)) records_[constraint->map_id].add(*constraint);
  });
  read(corrections_, [this](const auto& sample) { take(sample); });
  read(statuses_, [this](const auto& sample) { take(sample); });
  read(heartbeats_, [this](const slammot_Heartbeat& beat) {
    if (is_source(wire::text(beat.service_name))) last_ingest_ = Clock::now();
  });
  read(replies_, [this](const auto& sample) {
    if (wire::text(sample.requester) == requester_ && sample.result == slammot_OUTCOME_DONE)
      is_submap_finished_ = true;
  });
}

template <typename Sample, typename Handle>
void Collector::read(dds::Reader<Sample>& reader, Handle handle) {
  const auto owners =
      dds::has_one_writer(reader.topic()) ? std::make_shared<app::OwnerWatch>() : nullptr;
  wait_set_.on_data(reader, [this, &reader, handle, owners] {
    reader.take_each([&](const Sample& sample, const dds::SampleInfo& info) {
      if (!wire::is_about(sample, vehicle_id_)) return;
      const auto is_gone = [&](std::uint64_t writer) { return !reader.is_matched(writer); };
      if (!owners || owners->accepts({info.key_handle, info.writer_handle}, Clock::now(), is_gone))
        handle(sample);
    });
  });
}

bool Collector::wait(std::chrono::milliseconds longest) {
  admit(gate_.judge_held(localization::monotonic_ns()));
  return wait_set_.wait(longest) != dds::WaitSet::Wake::kStopped;
}

void Collector::restore(const files::RunJournal::Content& content) {
  is_restored_ = true;
  is_on_restored_drive_ = true;
  drive_ = content.drive;
  ended_.assign(content.ended.begin(), content.ended.end());
  for (const files::JournalScan& scan : content.scans) record_stamp(scan);
  gate_.take_up(drives_.drives());
  for (const flow::LocalizedScan& scan : content.localized_scans) {
    records_[scan.map_id].add(scan);
    last_localized_ns_ = scan.stamp_ns;
    submap_in_use_ = scan.submap_id;
  }
  for (const flow::TrackedObjects& tracked : content.tracked_objects) {
    records_[tracked.map_id].add(tracked);
    last_tracked_ns_ = tracked.stamp_ns;
  }
  journal_->resume();
}

/// Records the stamp of a scan. The first scan of a new drive discards those of the previous one.
void Collector::record_stamp(const files::JournalScan& scan) {
  const auto drive = drives_.judge(scan.scanner_id, scan.drive_id);
  if (drive == localization::DriveWatch::Scan::kOfEarlierDrive) return;
  if (drive == localization::DriveWatch::Scan::kOfNewDrive) {
    stamps_by_sequence_.clear();
    seen_at_.clear();
    is_on_restored_drive_ = false;
  }
  stamps_by_sequence_[scan.scanner_id].emplace(scan.sequence, scan.stamp_ns);
}

/// Records the stamp of a scan that passed while this process was down: only what became of it is
/// in the history of the bus.
void Collector::record_missed_stamp(const flow::LocalizedScan& scan) {
  const auto drive = drives_.drives().find(scan.scanner_id);
  if (!is_on_restored_drive_ || drive == drives_.drives().end()) return;
  if (!stamps_by_sequence_[scan.scanner_id].emplace(scan.sequence, scan.stamp_ns).second) return;
  if (journal_)
    journal_->add(files::JournalScan{scan.scanner_id, drive->second, scan.sequence, scan.stamp_ns});
}

void Collector::admit(const localization::DriveGate::Verdict& verdict) {
  for (const localization::WaitingScan& admitted : verdict.admitted) {
    if (verdict.begins_drive) drives_.readmit(admitted.drive_id);
    const files::JournalScan scan{admitted.scan.scanner.scanner_id, admitted.drive_id,
                                  admitted.scan.sequence, admitted.scan.stamp_ns};
    record_stamp(scan);
    if (journal_ && drive_) journal_->add(scan);
  }
}

void Collector::take(const slammot_LaserScan& sample) {
  last_progress_ = Clock::now();
  localization::WaitingScan scan{{}, sample.drive_id};
  scan.scan.stamp_ns = sample.stamp_ns;
  scan.scan.sequence = sample.sequence_number;
  scan.scan.scanner.scanner_id = wire::text(sample.scanner_id);
  seen_at_.emplace(sample.stamp_ns, Clock::now());
  admit(gate_.judge(std::move(scan), localization::monotonic_ns()));
}

/// Discards the results of the previous drive.
void Collector::begin_drive(const files::DriveName& drive) {
  if (drive_) {
    if (drive_->map_id == drive.map_id) records_[drive.map_id].forget_drive();
    else records_.erase(drive_->map_id);
    ended_.push_back(*drive_);
    if (ended_.size() > kEndedDrives) ended_.pop_front();
  }
  drive_ = drive;
  last_localized_ns_.reset();
  last_tracked_ns_.reset();
  submap_in_use_.reset();
  if (!journal_) return;
  journal_->begin(drive, std::vector(ended_.begin(), ended_.end()));
  for (const auto& [scanner_id, stamps] : stamps_by_sequence_) {
    for (const auto& [sequence, stamp_ns] : stamps)
      journal_->add(
          files::JournalScan{scanner_id, drives_.drives().at(scanner_id), sequence, stamp_ns});
  }
}

void Collector::take(const slammot_LocalizedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan) return;
  const files::DriveName drive{scan->map_id, scan->odom_id};
  if (has_ended(drive)) return;
  if (drive_ != drive) begin_drive(drive);
  record_missed_stamp(*scan);
  records_[scan->map_id].add(*scan);
  if (journal_) journal_->add(*scan);
  last_localized_ns_ = std::max(scan->stamp_ns, last_localized_ns_.value_or(scan->stamp_ns));
  submap_in_use_ = std::max(scan->submap_id, submap_in_use_.value_or(scan->submap_id));
  last_progress_ = Clock::now();
}

void Collector::take(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!objects || files::DriveName{objects->map_id, objects->odom_id} != drive_) return;
  records_[objects->map_id].add(*objects);
  if (journal_) journal_->add(*objects);
  last_tracked_ns_ = std::max(objects->stamp_ns, last_tracked_ns_.value_or(objects->stamp_ns));
  last_progress_ = Clock::now();
  const auto seen = seen_at_.find(objects->stamp_ns);
  if (seen == seen_at_.end()) return;
  scan_to_tracks_.add(Clock::now() - seen->second);
  seen_at_.erase(seen_at_.begin(), std::next(seen));
}

void Collector::take(const slammot_SubmapTile& tile) {
  auto added = submap_assembler_.add(tile);
  if (added.submap) records_[added.submap->map_id].add(std::move(*added.submap));
  last_progress_ = Clock::now();
}

void Collector::take(const slammot_GraphCorrection& part) {
  const auto added = correction_assembler_.add(part);
  if (!added.correction) return;
  const flow::MapId map_id = added.correction->map_id;
  records_[map_id].add(*added.correction);
  for (const flow::CorrectedSubmap& submap : added.correction->submaps)
    placed_submaps_.emplace(map_id, submap.submap_id);
  last_progress_ = Clock::now();
}

void Collector::take(const slammot_ServiceStatus& sample) {
  auto status = wire::decode(sample);
  if (!status) return;
  if (is_source(status->name.service))
    is_log_finished_[status->name.instance] = is_set(*status, "log_finished");
  status_by_service_[status->name.service] = std::move(*status);
}

bool Collector::has_ended(const files::DriveName& drive) const {
  return std::ranges::find(ended_, drive) != ended_.end();
}

bool Collector::is_log_finished() const {
  return !is_log_finished_.empty() &&
         std::ranges::all_of(is_log_finished_, [](const auto& one) { return one.second; });
}

bool Collector::is_last_scan_tracked() const {
  return last_tracked_ns_ &&
         std::ranges::all_of(stamps_by_sequence_, [this](const auto& of_scanner) {
           return of_scanner.second.rbegin()->second <= *last_tracked_ns_;
         });
}

bool Collector::has_drive_ended() const {
  if (stamps_by_sequence_.empty()) return false;
  const auto now = Clock::now();
  if (is_log_finished()) return is_last_scan_tracked() || now - last_progress_ > kFinalSilence;
  return is_restored_ && now - last_ingest_ > kIngestTimeout &&
         now - last_progress_ > kIngestTimeout;
}

void Collector::remove_journal() {
  if (journal_) journal_->remove();
}

void Collector::request_finished_submap() {
  wire::Command command;
  command.vehicle_id = vehicle_id_;
  command.service = "localization";
  command.requester = requester_;
  command.request_number = 1;  // The number stays the same: a repeated request is executed once.
  command.verb = "finish_submap";
  commands_.write(wire::encode(command));
}

bool Collector::is_complete() const {
  if (!is_submap_finished_) return false;
  if (!drive_ || !submap_in_use_) return true;
  const flow::MapId map_id = drive_->map_id;
  const auto record = records_.find(map_id);
  return record->second.submaps().contains(*submap_in_use_) &&
         placed_submaps_.contains({map_id, *submap_in_use_});
}

bool Collector::finish(std::chrono::seconds patience) {
  last_progress_ = Clock::now();
  auto ask_again_at = Clock::now();
  while (!is_complete()) {
    if (Clock::now() - last_progress_ > patience) return false;
    if (!is_submap_finished_ && Clock::now() >= ask_again_at) {
      request_finished_submap();
      ask_again_at = Clock::now() + kRepeatCommand;
    }
    if (!wait(100ms)) return false;
  }
  wait(50ms);  // For constraints and statuses in transit.
  return true;
}

/// Stamps of received scans: of one scanner by sequence number, of several by time.
std::vector<std::int64_t> Collector::scan_stamps_ns() const {
  std::vector<std::int64_t> stamps_ns;
  for (const auto& [scanner_id, stamps] : stamps_by_sequence_) {
    for (const auto& [sequence, stamp_ns] : stamps) stamps_ns.push_back(stamp_ns);
  }
  if (stamps_by_sequence_.size() > 1) std::ranges::sort(stamps_ns);
  return stamps_ns;
}

files::RunRecord Collector::record(const std::vector<std::int64_t>& scan_stamps_ns) const {
  const auto made = drive_ ? records_.find(drive_->map_id) : records_.end();
  files::RunRecord record = made == records_.end() ? files::RunRecord() : made->second;
  for (const std::int64_t stamp_ns : scan_stamps_ns) record.add_scan(stamp_ns);
  return record;
}

std::map<std::string, std::map<std::string, std::uint64_t>> Collector::counters() const {
  std::map<std::string, std::map<std::string, std::uint64_t>> counters;
  for (const auto& [service, status] : status_by_service_) {
    for (const wire::Counter& counter : status.counters)
      counters[service][counter.name] = counter.total;
  }
  return counters;
}

std::vector<files::StageLatency> Collector::latencies() const {
  std::vector<files::StageLatency> stages;
  for (const auto& [service, status] : status_by_service_) {
    for (const wire::StageLatency& stage : status.latencies) {
      stages.push_back(
          {service + "." + stage.stage, stage.calls, stage.p50_ms, stage.p99_ms, stage.highest_ms});
    }
  }
  stages.push_back({"scan_to_tracks", scan_to_tracks_.count(), scan_to_tracks_.percentile_ms(0.5),
                    scan_to_tracks_.percentile_ms(0.99), scan_to_tracks_.highest_ms()});
  return stages;
}

}  // namespace slammot
