#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/app/drive_mark.hpp"
#include "common/app/pace.hpp"
#include "common/app/readiness.hpp"
#include "common/app/run_service.hpp"
#include "common/sensing/gyro_odometry.hpp"
#include "common/simulation/drive.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/truth.hpp"

namespace slammot::simulator {

/// Simulates a drive on the bus in place of ingest, and publishes ground truth.
class SimulatorService {
 public:
  struct Settings {
    std::string scenario;               ///< Name or file.
    std::optional<std::uint64_t> seed;  ///< Replaces the scenario's seed.
    int ride = 0;                       ///< Index of the scenario's vehicle with scanners.
    std::string speed = "1";
    double wait_for_services_s = 20.0;
    bool linger = false;  ///< Continue after the end of the drive.
  };
  static constexpr const char* kName = "simulator";
  static constexpr const char* kPurpose =
      "Simulates a drive onto the bus: sensor data and ground truth.";
  static std::vector<config::BoundStage> stages(Settings&) {
    return {};
  }  ///< All settings are in the scenario file.
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws app::StartupFailure for an invalid scenario.
  SimulatorService(app::ServiceContext& context, const Settings& settings);

 private:
  using Time = app::Pace::Time;

  void wait_for_services();
  void begin();
  void skip_what_was_sent();
  void schedule();
  std::optional<simulation::SimulatedScan> next_scan();
  void send_next();
  void send(const simulation::SimulatedScan& drive);
  void take_labels(const slammot_ScanLabels& labels);
  void check_progress();
  void finish();

  app::ServiceContext& context_;
  app::Pace pace_;
  bool linger_;
  std::chrono::milliseconds patience_;  ///< Time to wait for absent services.
  Time give_up_waiting_at_;
  simulation::Drive drive_;
  sensing::GyroOdometry gyro_;
  app::DriveMark mark_;
  app::Readiness readiness_{{"localization", "detection", "tracking"}};
  dds::Writer<slammot_LaserScan>& scans_;
  dds::Writer<slammot_Odometry>& odometry_;
  dds::Writer<slammot_GnssFix>& fixes_;
  dds::Writer<slammot_CompassReading>& compass_readings_;
  dds::Writer<slammot_TruePose>& true_poses_;
  dds::Writer<slammot_TrueObjects>& true_objects_;
  dds::Writer<slammot_TrueHits>& true_hits_;
  wire::LaserScanEncoder encoder_;
  wire::TruthEncoder truth_;
  bool has_begun_ = false;
  bool has_finished_ = false;
  std::optional<simulation::SimulatedScan> next_;
  /// At speed max: the scan whose labels are pending, and the time since when.
  std::optional<std::int64_t> unanswered_ns_;
  Time unanswered_since_{};
};

}  // namespace slammot::simulator
