#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/geodetic.hpp"
#include "common/streets/street_localization.hpp"

namespace slammot::files {

/// A place of the map on the streets.
struct StreetPlace {
  geometry::Geodetic map_origin;
  double x_from_east_rad = 0.0;  ///< Direction of the map's x axis, counter-clockwise from east.
  double probability = 0.0;
  double share = 0.0;  ///< Of the way on streets.
};

/// Where the drive lies in a street graph.
struct StreetFindings {
  streets::StreetVerdict verdict = streets::StreetVerdict::kTooShort;
  double way_m = 0.0;  ///< That was compared with the streets.
  std::optional<double> located_after_m;
  std::vector<StreetPlace> places;  ///< Best first; at most five.
};

StreetFindings findings_of(const streets::StreetSearch& search, const geometry::Geodetic& origin);

/// Conclusion in one line without a full stop: "located after 240 m, 93 % of the way on streets".
std::string describe_streets(const StreetFindings& findings);

/// "located", "ambiguous", ... as in the report.
const char* name_of(streets::StreetVerdict verdict);

/// Member "streets" of report.json, as text.
std::string to_json_text(const StreetFindings& findings);

}  // namespace slammot::files
