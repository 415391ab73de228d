#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "common/files/result.hpp"
#include "common/flow/submap.hpp"

namespace slammot {

/// Submaps of the latest map in a database of map_store, ascending. `path` is the file or the folder that holds it as
/// map.sqlite: what `run --store-map` wrote, or the state folder of map_store.
files::Result<std::vector<flow::Submap>> read_stored_map(const std::filesystem::path& path);

/// Writes them as map.sqlite into the folder, which must exist; replaces the one that is there.
std::optional<files::Error> write_stored_map(const std::filesystem::path& folder, const std::map<flow::SubmapId, flow::Submap>& submaps);

}  // namespace slammot
