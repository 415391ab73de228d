#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/latency_histogram.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/reader.hpp"
#include "common/dds/wait_set.hpp"
#include "common/dds/writer.hpp"
#include "common/files/run_journal.hpp"
#include "common/files/run_record.hpp"
#include "common/files/run_report.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/service.hpp"
#include "common/wire/submap.hpp"
#include "services/localization/drive_gate.hpp"
#include "services/localization/drive_watch.hpp"

namespace slammot {

struct CollectorOptions {
  std::string vehicle_id = "vehicle";
  std::uint32_t domain_id = 0;
  std::optional<std::string> dds_config;  ///< Cyclone configuration (XML); default: from the
                                          ///< environment.
  std::filesystem::path journal{};  ///< File that records received data for a restart; empty: none.
};

/// Collects the results of the services for the current drive from the bus. A new drive discards
/// the results of the previous one. All handlers run in the thread that calls wait().
class Collector {
 public:
  explicit Collector(const CollectorOptions& options);

  /// Handles received data for at most this time; false once stopped.
  bool wait(std::chrono::milliseconds longest);

  /// Makes wait() return false. May be called from any thread.
  void stop() { wait_set_.stop(); }

  /// True if a drive was received, all sources have finished, and tracking has processed the last
  /// scan or is silent. A drive restored from a journal has also ended after 30 s without ingest.
  bool has_drive_ended() const;

  /// Finishes the current submap and waits until it is stored and in the graph. False if nothing
  /// arrives for `patience` before that; the results then lack the submap.
  bool finish(std::chrono::seconds patience);

  /// Latest stamp of a localized scan.
  std::optional<std::int64_t> last_localized_ns() const { return last_localized_ns_; }

  /// Removes the journal, once the results are written.
  void remove_journal();

  /// Results of the drive, with a row for each of `scan_stamps_ns`: all scans of the log, or the
  /// received ones (scan_stamps_ns()) if the log is not available.
  files::RunRecord record(const std::vector<std::int64_t>& scan_stamps_ns) const;
  std::vector<std::int64_t> scan_stamps_ns() const;

  std::map<std::string, std::map<std::string, std::uint64_t>> counters() const;
  std::vector<files::StageLatency> latencies() const;

 private:
  using Clock = std::chrono::steady_clock;

  template <typename Sample, typename Handle>
  void read(dds::Reader<Sample>& reader, Handle handle);
  void take(const slammot_LaserScan& scan);
  void take(const slammot_LocalizedScan& sample);
  void take(const slammot_TrackedObjects& sample);
  void take(const slammot_SubmapTile& tile);
  void take(const slammot_GraphCorrection& part);
  void take(const slammot_ServiceStatus& status);
  void restore(const files::RunJournal::Content& content);
  void begin_drive(const files::DriveName& drive);
  void record_stamp(const files::JournalScan& scan);
  void record_missed_stamp(const flow::LocalizedScan& scan);
  void admit(const localization::DriveGate::Verdict& verdict);
  bool has_ended(const files::DriveName& drive) const;
  bool is_log_finished() const;
  bool is_last_scan_tracked() const;
  void request_finished_submap();
  bool is_complete() const;

  std::string vehicle_id_;
  std::optional<files::RunJournal::Content> restored_;  ///< What the process before has left.
  dds::Participant participant_;
  dds::WaitSet wait_set_;
  dds::Reader<slammot_LaserScan> laser_scans_;
  dds::Reader<slammot_LocalizedScan> localized_scans_;
  dds::Reader<slammot_TrackedObjects> tracked_objects_;
  dds::Reader<slammot_SegmentedScan> segmented_scans_;
  dds::Reader<slammot_ScanLabels> scan_labels_;
  dds::Reader<slammot_SubmapTile> stored_tiles_;
  dds::Reader<slammot_Constraint> constraints_;
  dds::Reader<slammot_GraphCorrection> corrections_;
  dds::Reader<slammot_ServiceStatus> statuses_;
  dds::Reader<slammot_Heartbeat> heartbeats_;
  dds::Reader<slammot_Reply> replies_;
  dds::Writer<slammot_Command> commands_;
  wire::SubmapAssembler submap_assembler_;
  wire::GraphCorrectionAssembler correction_assembler_;

  std::optional<files::RunJournal> journal_;
  bool is_restored_ = false;  ///< From a journal.
  bool is_on_restored_drive_ = false;
  localization::DriveGate gate_;  ///< Keeps strays of other drives out.
  localization::DriveWatch drives_;
  /// Of the current drive, by scanner.
  std::map<std::string, std::map<std::uint32_t, std::int64_t>> stamps_by_sequence_;
  std::optional<files::DriveName> drive_;  ///< Of the latest localized scan.
  /// Before this one: the history of the bus may begin with them.
  std::deque<files::DriveName> ended_;
  /// Results by map: the bus also delivers retained data of earlier maps.
  std::map<flow::MapId, files::RunRecord> records_;
  /// Reception times of scans without tracks, by stamp.
  std::map<std::int64_t, Clock::time_point> seen_at_;
  app::LatencyHistogram scan_to_tracks_;
  std::optional<std::int64_t> last_localized_ns_;
  std::optional<std::int64_t> last_tracked_ns_;
  std::optional<flow::SubmapId> submap_in_use_;
  /// Submaps in the graph.
  std::set<std::pair<flow::MapId, flow::SubmapId>> placed_submaps_;
  std::map<std::string, wire::ServiceStatus> status_by_service_;
  std::map<std::string, bool> is_log_finished_;  ///< By instance of ingest or simulator.
  Clock::time_point last_ingest_;                ///< Its last heartbeat.
  bool is_submap_finished_ = false;
  std::string requester_;
  Clock::time_point last_progress_;
};

}  // namespace slammot
