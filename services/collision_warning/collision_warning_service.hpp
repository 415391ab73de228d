#pragma once

#include <vector>

#include "common/app/run_service.hpp"
#include "common/wire/collision_warnings.hpp"
#include "services/collision_warning/collision_monitor.hpp"

namespace slammot::collision_warning {

/// Publishes the predicted encounters with the tracked objects of each scan.
class CollisionWarningService {
 public:
  struct Settings {
    CollisionWarningConfig config;
  };
  static constexpr const char* kName = "collision_warning";
  static constexpr const char* kPurpose =
      "Warns of tracked objects on a collision course with the vehicle.";
  static std::vector<config::BoundStage> stages(Settings& settings);
  static void add_options(CLI::App&, Settings&) {}

  CollisionWarningService(app::ServiceContext& context, const Settings& settings);

 private:
  void take(const slammot_TrackedObjects& sample);
  void count(flow::WarningLevel level);

  app::ServiceContext& context_;
  CollisionMonitor monitor_;
  dds::Writer<slammot_CollisionWarnings>& warnings_;
  wire::CollisionWarningsEncoder encoder_;
  flow::WarningLevel last_level_ = flow::WarningLevel::kNone;
};

}  // namespace slammot::collision_warning
