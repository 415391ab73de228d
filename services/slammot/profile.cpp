#include "services/slammot/profile.hpp"

#include "common/config/profiles.hpp"
#include "services/collision_warning/collision_warning_fields.hpp"
#include "services/detection/detection_fields.hpp"
#include "services/ingest/ingest_fields.hpp"
#include "services/localization/localization_fields.hpp"
#include "services/loop_closing/loop_closing_fields.hpp"
#include "services/map_store/map_store_fields.hpp"
#include "services/tracking/tracking_fields.hpp"

namespace slammot {
namespace {

const config::FieldTable<ImplementationChoice>& implementation_fields() {
  using C = ImplementationChoice;
  static const config::FieldTable<C> table = {
      {"localization", &C::localization,
       "Implementation of localization that run and bench use: standard or icp."},
      {"tracking", &C::tracking,
       "Implementation of tracking that run and bench use: standard or greedy."},
  };
  return table;
}

}  // namespace

std::vector<config::BoundStage> bind_stages(Profile& profile) {
  return {
      config::bind_stage("ingest", ingest::ingest_fields(), profile.ingest),
      config::bind_stage("localization", localization::localization_fields(), profile.localization),
      config::bind_stage("detection", detection::detection_fields(), profile.detection),
      config::bind_stage("tracking", tracking::tracking_fields(), profile.tracking),
      config::bind_stage("loop_closing", loop_closing::loop_closing_fields(), profile.loop_closing),
      config::bind_stage("map_store", map_store::map_store_fields(), profile.map_store),
      config::bind_stage("collision_warning", collision_warning::collision_warning_fields(),
                         profile.collision_warning),
      config::bind_stage("implementations", implementation_fields(), profile.implementations),
  };
}

std::optional<std::string> load_settings(const std::string& profile_name,
                                         const std::filesystem::path& config_file,
                                         Profile& profile) {
  const std::vector<config::BoundStage> stages = bind_stages(profile);
  if (!profile_name.empty()) {
    const auto profile_file = config::find_profile(profile_name);
    if (!profile_file) return config::unknown_profile(profile_name);
    if (const auto fault = config::overlay_file(*profile_file, stages)) return fault->text();
  }
  if (config_file.empty()) return std::nullopt;
  const auto fault = config::overlay_file(config_file, stages);
  return fault ? std::optional(fault->text()) : std::nullopt;
}

}  // namespace slammot
