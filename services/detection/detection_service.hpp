#pragma once

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

  DetectionService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_LocalizedScan& sample);

  app::ServiceContext& context_;
  Detector detector_;
  flow::SegmentedScan segmented_scan_;  ///< Its memory is reused for the next scan.
  dds::Writer<slammot_SegmentedScan>& segmented_scans_;
  wire::SegmentedScanEncoder encoder_;
};

}  // namespace slammot::detection
