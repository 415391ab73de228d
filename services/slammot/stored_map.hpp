#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "common/flow/submap.hpp"
#include "common/traffic/submap_traffic.hpp"

namespace slammot {

/// Submaps of the latest map in a database of map_store, ascending. `path`: the file, or the folder
/// that contains it as map.sqlite (output of `run --store-map`, or map_store's state folder). A map
/// with another cell size than `cell_size_m` is rejected.
files::Result<std::vector<flow::Submap>> read_stored_map(const std::filesystem::path& path,
                                                         double cell_size_m);

/// Number of submaps of `second` whose walls and cells are those of a submap of `first`, to the
/// bit: both maps hold the same drive. Numbers and poses do not count, since a merge changes them.
std::size_t submaps_in_common(const std::vector<flow::Submap>& first,
                              const std::vector<flow::Submap>& second);

/// The database that a path means, in one spelling: two paths are of one map if these are equal.
std::filesystem::path database_of(const std::filesystem::path& path);

/// Writes the submaps as map.sqlite into the folder, which must exist; replaces an existing file.
std::optional<files::Error> write_stored_map(const std::filesystem::path& folder,
                                             const std::vector<flow::Submap>& submaps,
                                             const std::string& vehicle_id);

/// As above, for the default vehicle id.
std::optional<files::Error> write_stored_map(const std::filesystem::path& folder,
                                             const std::map<flow::SubmapId, flow::Submap>& submaps);

/// What moved in the latest map of a database (as for read_stored_map). Damaged records are left
/// out.
files::Result<traffic::SubmapTraffic> read_stored_traffic(const std::filesystem::path& path);

/// Adds what moved to the latest map of the database in the folder, which has the submaps.
std::optional<files::Error> write_stored_traffic(const std::filesystem::path& folder,
                                                 const traffic::SubmapTraffic& traffic);

/// Copies what moved in the latest map of a database to the one in the folder, which has its
/// submaps.
std::optional<files::Error> copy_traffic(const std::filesystem::path& path,
                                         const std::filesystem::path& folder);

}  // namespace slammot
