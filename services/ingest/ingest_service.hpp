#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/drive_mark.hpp"
#include "common/app/pace.hpp"
#include "common/app/readiness.hpp"
#include "common/app/run_service.hpp"
#include "common/wire/sensor.hpp"
#include "services/ingest/backlog.hpp"
#include "services/ingest/graph_watch.hpp"
#include "services/ingest/ingest_config.hpp"
#include "services/ingest/log_source.hpp"
#include "services/ingest/scan_window.hpp"

namespace slammot::ingest {

/// Plays a recorded drive on the bus.
class IngestService {
 public:
  struct Settings {
    IngestConfig config;
    std::filesystem::path input;
    files::TopicOptions topics;
    std::string speed = "1";
    bool linger = false;       ///< Continue to run after the end of the log.
    bool forgive_cut = false;  ///< A truncated log gives exit code 0.
  };
  static constexpr const char* kName = "ingest";
  static constexpr const char* kPurpose =
      "Plays a recorded drive (a CARMEN log or a ROS bag) on the bus.";
  static constexpr int kExitCut = 3;  ///< The log is truncated.
  static constexpr bool kKeepsState = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws app::StartupFailure for a log that cannot be played.
  IngestService(app::ServiceContext& context, const Settings& settings);

 private:
  void wait_for_services();
  void begin();
  void proceed();
  void proceed_at_pace();
  void send_backlog();
  app::CommandResult set_speed(std::string_view speed);
  void proceed_at_max_speed();
  void take_labels(const slammot_ScanLabels& labels);
  void watch_graph();
  void take_localized(const slammot_LocalizedScan& scan);
  bool is_own(std::string_view scanner_id) const;
  bool fetch();
  bool is_acknowledged(const sensing::LaserScan& scan) const;
  void send_once(const Step& step);
  void send(const Step& step);
  void check_progress();
  void finish();

  app::ServiceContext& context_;
  IngestConfig config_;
  bool linger_;
  bool forgive_cut_;
  LogSource source_;
  std::vector<std::string> scanner_ids_;
  app::DriveMark drive_;
  app::Pace pace_;
  Backlog backlog_;
  ScanWindow window_;
  GraphWatch graph_;
  app::Readiness readiness_{{"localization", "detection", "tracking"}};
  dds::Writer<slammot_LaserScan>& scans_;
  dds::Writer<slammot_Odometry>& odometry_;
  dds::Writer<slammot_GnssFix>& fixes_;
  dds::Writer<slammot_CompassReading>& headings_;
  wire::LaserScanEncoder encoder_;
  std::chrono::steady_clock::time_point give_up_waiting_at_;
  bool has_begun_ = false;
  bool has_finished_ = false;
  bool is_timer_set_ = false;  ///< At a given speed: for the next step.
  bool has_sent_scan_ = false;
  std::optional<Step> fetched_;                  ///< Next step to send.
  std::deque<Step> in_flight_;                   ///< At speed max: sent, without labels.
  std::optional<std::int64_t> acknowledged_ns_;  ///< Stamp of the latest processed scan.
  std::set<std::string> acknowledged_scanners_;  ///< Scanners whose scans of that stamp are
                                                 ///< processed.
};

}  // namespace slammot::ingest
