#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/app/run_service.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/submap.hpp"
#include "examples/icp_localizer/icp_localizer.hpp"

namespace slammot::icp_localizer {

/// Runs the localizer as the service localization: decodes, calls and encodes. Each process and
/// each drive begins a new map.
class IcpLocalizerService {
 public:
  struct Settings {
    IcpLocalizerConfig config;
  };
  static constexpr const char* kName = "localization";  ///< Name on the bus; other services wait
                                                        ///< for its heartbeat and send it commands.
  static constexpr const char* kPurpose =
      "Example of a service that replaces slammot-localization: ICP against the recent scans.";
  static constexpr bool kIsOnePerVehicle = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  IcpLocalizerService(app::ServiceContext& context, const Settings& settings);

 private:
  struct Waiting {
    sensing::LaserScan scan;
    std::uint64_t drive_id = 0;
    std::int64_t published_ns = 0;  ///< By the system clock of its source.
    int cycles = 0;                 ///< Cycles of the service since the scan arrived.
  };

  void take(const slammot_LaserScan& sample, const dds::SampleInfo& info);
  void take(const slammot_Odometry& sample);
  void take(const slammot_ScanLabels& sample);
  void take(const slammot_GraphCorrection& sample);
  void localize_waiting();
  bool awaits_odometry(const Waiting& waiting) const;
  void begin_drive_of(const Waiting& waiting);
  void localize(const Waiting& waiting);
  void publish_finished_submaps();
  app::CommandResult finish_submap();

  app::ServiceContext& context_;
  IcpLocalizerConfig config_;
  IcpLocalizer localizer_;
  dds::Writer<slammot_LocalizedScan>& localized_scans_;
  dds::Writer<slammot_SubmapTile>& tiles_;
  wire::LocalizedScanEncoder scan_encoder_;
  wire::SubmapEncoder submap_encoder_;
  wire::GraphCorrectionAssembler corrections_;
  std::deque<Waiting> waiting_;
  std::deque<sensing::Odometry> recent_odometry_;  ///< For a drive whose odometry precedes its
                                                   ///< first scan.
  int scans_without_odometry_ = 0;                 ///< Consecutive ones.
  std::map<std::string, std::uint64_t> drive_by_scanner_;
  flow::MapId map_id_;                                         ///< Also the id of the frame odom.
  std::map<std::string, flow::LocalizedScan> last_published_;  ///< By scanner.
};

}  // namespace slammot::icp_localizer
