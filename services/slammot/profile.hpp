#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/config/overlay.hpp"
#include "services/detection/detector.hpp"
#include "services/ingest/ingest_config.hpp"
#include "services/localization/localizer.hpp"
#include "services/loop_closing/loop_closer.hpp"
#include "services/map_store/map_store_config.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot {

/// Which implementation of a stage runs, by its name in implementations.cpp.
struct ImplementationChoice {
  std::string localization = "standard";
  std::string tracking = "standard";
};

/// The settings of all stages, for what runs all of them.
struct Profile {
  ingest::IngestConfig ingest;
  localization::LocalizerConfig localization;
  detection::DetectionConfig detection;
  tracking::TrackingConfig tracking;
  loop_closing::LoopClosingConfig loop_closing;
  map_store::MapStoreConfig map_store;
  ImplementationChoice implementations;
};

/// Every stage of the profile, for config::overlay_file(), config::print() and
/// config::find_fault(). Points into it.
std::vector<config::BoundStage> bind_stages(Profile& profile);

/// Overlays a profile, by name or file, and then a file with settings; either may be empty.
/// Otherwise why that is not possible, in one line.
std::optional<std::string> load_settings(const std::string& profile_name,
                                         const std::filesystem::path& config_file,
                                         Profile& profile);

}  // namespace slammot
