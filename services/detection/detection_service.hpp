#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/segmented_scan.hpp"
#include "services/detection/detector.hpp"

namespace slammot::detection {

/// Segments localized scans. Of earlier scans it knows the echoes of the last one, for false
/// echoes.
class DetectionService {
 public:
  struct Settings {
    DetectionConfig config;
  };
  static constexpr const char* kName = "detection";
  static constexpr const char* kPurpose =
      "Segments scans and labels the segments that contradict the map as moving.";
  static constexpr bool kIsOnePerVehicle = true;
  static constexpr bool kKeepsState = true;  ///< None but the lock: a leader that hangs is ended.
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  static void prepare(app::ServiceContext& context);

  DetectionService(app::ServiceContext& context, const Settings& settings);

 private:
  /// Newest scan of a scanner that the leader before segmented while this process stood by.
  struct DoneScan {
    flow::OdomId odom_id;
    std::int64_t stamp_ns = 0;
  };

  void take(const slammot_LocalizedScan& sample);
  bool was_done_before(const flow::LocalizedScan& scan);

  app::ServiceContext& context_;
  Detector detector_;
  std::map<std::string, DoneScan> done_before_;  ///< By scanner, until a newer scan comes.
  flow::SegmentedScan segmented_scan_;           ///< Its memory is reused for the next scan.
  dds::Writer<slammot_SegmentedScan>& segmented_scans_;
  wire::SegmentedScanEncoder encoder_;
};

}  // namespace slammot::detection
