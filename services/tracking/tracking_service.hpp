#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/tracking/tracker.hpp"

namespace slammot::tracking {

/// Follows moving objects from segmented scan to segmented scan, and takes up its last tracks when
/// it starts again.
class TrackingService {
 public:
  struct Settings {
    TrackingConfig config;
  };
  static constexpr const char* kName = "tracking";
  static constexpr const char* kPurpose =
      "Follows moving objects, and tells what each point of a scan is.";
  static constexpr bool kIsOnePerVehicle = true;
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  TrackingService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_SegmentedScan& sample);
  void take_stored(const slammot_TrackedObjects& sample);
  void begin();
  void begin_drive(const flow::SegmentedScan& first);
  void resume(std::int64_t stamp_ns);
  void track(const flow::SegmentedScan& scan);
  void publish(const TrackingResult& result);

  app::ServiceContext& context_;
  TrackingConfig config_;
  Tracker tracker_;
  dds::Writer<slammot_TrackedObjects>& objects_;
  dds::Writer<slammot_ScanLabels>& labels_;
  wire::TrackedObjectsEncoder objects_encoder_;
  wire::ScanLabelsEncoder labels_encoder_;
  bool waits_for_stored_tracks_ = true;
  std::optional<std::pair<flow::MapId, flow::OdomId>> drive_;  ///< None before the first scan.
  std::optional<flow::TrackedObjects> stored_;
  std::deque<flow::SegmentedScan> early_;               ///< Came while waiting for stored tracks.
  std::map<std::string, TrackingResult> last_results_;  ///< By scanner.
};

}  // namespace slammot::tracking
