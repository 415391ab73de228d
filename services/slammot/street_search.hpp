#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/files/map_image.hpp"
#include "common/files/result.hpp"
#include "common/files/run_record.hpp"
#include "common/files/street_findings.hpp"
#include "common/streets/street_graph.hpp"

namespace CLI {
class App;
}

namespace slammot {

/// Options of the search for a drive in a street graph.
struct StreetOptions {
  std::filesystem::path file;  ///< OpenStreetMap XML or GeoJSON; empty: no search.
  std::string near;            ///< "LATITUDE,LONGITUDE" of the start; empty: from GNSS, or unknown.
  double within_m = 100.0;     ///< Of the start.
  std::optional<double> x_from_east_rad{};  ///< Direction of the map, if it is known.
};

/// A street graph with what is known of the drive.
struct StreetJob {
  streets::StreetGraph graph;
  std::optional<streets::StartArea> start;  ///< Where the drive begins; no direction.
  std::optional<double> x_from_east_rad{};  ///< Direction of the map.
};

/// Longest way that is compared with the streets.
inline constexpr double kMostStreetWay_m = 1000.0;

void add_street_options(CLI::App& command, StreetOptions& options);

/// Reads the street graph; none without a file. Fails if the start is so far from all streets that
/// no way that is compared reaches one.
files::Result<std::optional<StreetJob>> prepare_streets(const StreetOptions& options);

/// Searches for the trajectory. What is not known of the start is taken from the georeference; a
/// place that is far from all streets is not used, which is said on stderr. `map`: the SO-map, in
/// which side streets are seen; null: none is used.
files::StreetFindings find_on_streets(const StreetJob& job,
                                      const std::vector<files::StampedPose>& trajectory,
                                      const std::optional<flow::Georeference>& georeference,
                                      const files::MapImage* map);

/// The SO-map of a drive.
files::MapImage map_of(const files::RunRecord& record);

}  // namespace slammot
