#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/flow/submap.hpp"

namespace slammot {

/// Submaps of the latest map in a database of map_store, ascending. `path` is the file or the
/// folder that holds it as map.sqlite: what `run --store-map` wrote, or the state folder of
/// map_store. cell_size_m: of the profile that is to go on in it; a map with others is refused.
files::Result<std::vector<flow::Submap>> read_stored_map(const std::filesystem::path& path,
                                                         double cell_size_m);

/// Writes them as map.sqlite into the folder, which must exist; replaces the one that is there.
std::optional<files::Error> write_stored_map(const std::filesystem::path& folder,
                                             const std::vector<flow::Submap>& submaps,
                                             const std::string& vehicle_id);

/// The same for what a run made, under the name that services have unless told another.
std::optional<files::Error> write_stored_map(const std::filesystem::path& folder,
                                             const std::map<flow::SubmapId, flow::Submap>& submaps);

}  // namespace slammot
