#pragma once

#include <chrono>
#include <cstdint>
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
#include "services/localization/drive_watch.hpp"

namespace slammot {

struct CollectorOptions {
  std::string vehicle_id = "vehicle";
  std::uint32_t domain_id = 0;
  std::optional<std::string> dds_config;  ///< Cyclone XML; the environment's when not set.
  std::filesystem::path journal{};  ///< Where to write what comes, to go on from after a crash;
                                    ///< empty: nowhere.
};

/// Takes from the bus what the services make of a drive: the one that is being driven, so that a
/// new one forgets the one before. Everything happens in the thread that calls wait().
class Collector {
 public:
  explicit Collector(const CollectorOptions& options);

  /// Handles what comes, for at most this long; false once stopped.
  bool wait(std::chrono::milliseconds longest);

  /// Makes wait() return false, from any thread.
  void stop() { wait_set_.stop(); }

  /// Whether there was a drive, ingest has said that its log is finished, and tracking has answered
  /// the last scan or will not any more. Taken up from a journal a drive has also ended when ingest
  /// has been gone for long.
  bool has_drive_ended() const;

  /// Ends the submap in progress and waits for what follows from it: the submap stored, and its
  /// place in the graph. False when nothing more comes for the given time before that; what is
  /// there then is what there is.
  bool finish(std::chrono::seconds patience);

  /// Newest stamp that was localized.
  std::optional<std::int64_t> last_localized_ns() const { return last_localized_ns_; }

  /// Its results are written: nothing to go on from any more.
  void forget_journal();

  /// What came of the drive. scan_stamps_ns: every scan of it; those that were on the bus where the
  /// log is not at hand.
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
  void take_up(const files::RunJournal::Content& content);
  void begin_drive(flow::MapId map_id, flow::OdomId odom_id);
  void remember(const files::JournalScan& scan);
  bool is_log_finished() const;
  bool is_last_scan_tracked() const;
  void ask_to_finish_submap();
  bool is_complete() const;

  std::string vehicle_id_;
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
  bool is_taken_up_ = false;  ///< From a journal.
  localization::DriveWatch drives_;
  std::map<std::string, std::map<std::uint32_t, std::int64_t>> stamps_by_sequence_;  ///< By
                                                                                     ///< scanner;
                                                                                     ///< of its
                                                                                     ///< drive.
  std::optional<flow::MapId> map_id_;                ///< Of the newest localized scan,
  flow::OdomId odom_id_;                             ///< and its drive in that map.
  std::map<flow::MapId, files::RunRecord> records_;  ///< What the bus keeps of earlier maps comes,
                                                     ///< too.
  std::map<std::int64_t, Clock::time_point> seen_at_;  ///< Scans without tracks so far, by stamp.
  app::LatencyHistogram scan_to_tracks_;
  std::optional<std::int64_t> last_localized_ns_;
  std::optional<std::int64_t> last_tracked_ns_;
  std::optional<flow::SubmapId> submap_in_use_;
  std::set<std::pair<flow::MapId, flow::SubmapId>> placed_submaps_;  ///< In the graph.
  std::map<std::string, wire::ServiceStatus> status_by_service_;
  std::map<std::string, bool> is_log_finished_;  ///< By instance of ingest.
  Clock::time_point last_ingest_;                ///< Heartbeat.
  bool is_submap_finished_ = false;
  std::string requester_;
  Clock::time_point last_progress_;
};

}  // namespace slammot
