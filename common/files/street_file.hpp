#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/files/result.hpp"
#include "common/streets/street_graph.hpp"

namespace slammot::files {

/// Reads the streets of an OpenStreetMap extract (XML: ways with the tag highway that cars may use)
/// or of GeoJSON (LineString and MultiLineString features; those with a property highway as in
/// OpenStreetMap). The content decides which. The graph's origin is the first point. Fails with one
/// line if the file cannot be read, is damaged or has no street.
Result<streets::StreetGraph> read_streets(const std::filesystem::path& file);

/// The same from text; `name` is for messages.
Result<streets::StreetGraph> parse_streets(std::string_view text, const std::string& name);

/// GeoJSON of the streets, one LineString each, with the property name.
std::string to_geojson(const streets::StreetGraph& graph);

}  // namespace slammot::files
