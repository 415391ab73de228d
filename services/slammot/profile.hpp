#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/config/overlay.hpp"
#include "services/collision_warning/collision_warning_config.hpp"
#include "services/detection/detector.hpp"
#include "services/ingest/ingest_config.hpp"
#include "services/localization/localizer.hpp"
#include "services/loop_closing/loop_closer.hpp"
#include "services/map_store/map_store_config.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot {

/// Names of the implementations in implementations.cpp.
struct ImplementationChoice {
  std::string localization = "standard";
  std::string tracking = "standard";
};

/// Settings of all stages.
struct Profile {
  ingest::IngestConfig ingest;
  localization::LocalizerConfig localization;
  detection::DetectionConfig detection;
  tracking::TrackingConfig tracking;
  loop_closing::LoopClosingConfig loop_closing;
  map_store::MapStoreConfig map_store;
  collision_warning::CollisionWarningConfig collision_warning;
  ImplementationChoice implementations;
};

/// All stages of the profile, for config::overlay_file(), config::print() and config::find_fault().
/// The result refers to `profile`.
std::vector<config::BoundStage> bind_stages(Profile& profile);

/// Overlays a profile (name or file), then a settings file; either may be empty. Returns one line
/// if that fails.
std::optional<std::string> load_settings(const std::string& profile_name,
                                         const std::filesystem::path& config_file,
                                         Profile& profile);

}  // namespace slammot
