#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/app/run_service.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/tracked_objects.hpp"
#include "examples/greedy_tracker/greedy_tracker.hpp"

namespace slammot::greedy_tracker {

/// Runs the tracker as the service tracking: decodes, calls and encodes.
class GreedyTrackerService {
 public:
  struct Settings {
    GreedyTrackerConfig config;
  };
  static constexpr const char* kName = "tracking";  ///< Name on the bus; other services wait for
                                                    ///< its heartbeat.
  static constexpr const char* kPurpose =
      "Example of a service that replaces slammot-tracking: nearest neighbour, one Kalman filter.";
  static constexpr bool kIsOnePerVehicle = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  GreedyTrackerService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_SegmentedScan& sample);
  void begin_drive_of(const flow::SegmentedScan& scan);
  void publish(const stages::TrackingResult& result, std::int64_t scan_published_ns);

  app::ServiceContext& context_;
  GreedyTrackerConfig config_;
  GreedyTracker tracker_;
  dds::Writer<slammot_TrackedObjects>& objects_;
  dds::Writer<slammot_ScanLabels>& labels_;
  wire::TrackedObjectsEncoder objects_encoder_;
  wire::ScanLabelsEncoder labels_encoder_;
  std::optional<std::pair<flow::MapId, flow::OdomId>> drive_;   ///< Empty before the first scan.
  std::map<std::string, stages::TrackingResult> last_results_;  ///< By scanner.
};

}  // namespace slammot::greedy_tracker
