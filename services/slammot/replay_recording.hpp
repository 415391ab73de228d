#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "common/mcap/file.hpp"
#include "services/slammot/replay_plan.hpp"

namespace slammot {

/// Vehicles whose data triggered the service.
std::set<std::string> vehicles_in(const mcap::File& file, const ReplayPlan& plan);

/// Ids that localization made of the clock for the vehicle's drives, in their order.
std::vector<std::string> drive_ids(const mcap::File& file, const std::string& vehicle_id);

/// The settings that the recorder was given, as files in the folder.
std::vector<std::filesystem::path> extract_settings(const mcap::File& file,
                                                    const std::filesystem::path& folder);

}  // namespace slammot
