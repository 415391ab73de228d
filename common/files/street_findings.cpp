#include "common/files/street_findings.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "common/files/text.hpp"

namespace slammot::files {
namespace {

constexpr std::size_t kMostPlaces = 5;

double rounded(double value, double scale) { return std::round(value * scale) / scale; }

}  // namespace

StreetFindings findings_of(const streets::StreetSearch& search, const geometry::Geodetic& origin) {
  const streets::StreetLocation& location = search.location;
  StreetFindings findings{location.verdict, location.way_m, search.located_after_m, {}};
  // One search that is sure and not confirmed by the next does not count.
  if (!search.located_after_m && location.verdict == streets::StreetVerdict::kLocated)
    findings.verdict = streets::StreetVerdict::kAmbiguous;
  for (const streets::StreetFit& fit : location.fits) {
    if (findings.places.size() == kMostPlaces) break;
    const geometry::Pose2& pose = fit.streets_from_map;
    findings.places.push_back({geometry::geodetic_at(origin, pose.translation_m()),
                               pose.heading_rad, fit.probability, fit.share});
  }
  return findings;
}

std::string describe_streets(const StreetFindings& findings) {
  switch (findings.verdict) {
    case streets::StreetVerdict::kTooShort:
      return text("the way of %.0f m is too short to be found", findings.way_m);
    case streets::StreetVerdict::kNotOnStreets:
      return text("the way of %.0f m lies beside the streets of the graph", findings.way_m);
    case streets::StreetVerdict::kAmbiguous:
      return text("ambiguous after %.0f m: %zu places fit, the best with probability %.2f",
                  findings.way_m, findings.places.size(), findings.places.front().probability);
    case streets::StreetVerdict::kLocated:
      return text("located after %.0f m, %.0f %% of the way on streets", findings.way_m,
                  100.0 * findings.places.front().share);
  }
  return {};
}

const char* name_of(streets::StreetVerdict verdict) {
  switch (verdict) {
    case streets::StreetVerdict::kTooShort: return "too_short";
    case streets::StreetVerdict::kNotOnStreets: return "not_on_streets";
    case streets::StreetVerdict::kAmbiguous: return "ambiguous";
    case streets::StreetVerdict::kLocated: return "located";
  }
  return "";
}

std::string to_json_text(const StreetFindings& findings) {
  nlohmann::ordered_json json = {{"conclusion", describe_streets(findings)},
                                 {"verdict", name_of(findings.verdict)},
                                 {"way_m", rounded(findings.way_m, 10.0)}};
  json["located_after_m"] = findings.located_after_m
                                ? nlohmann::ordered_json(rounded(*findings.located_after_m, 10.0))
                                : nlohmann::ordered_json();
  json["places"] = nlohmann::ordered_json::array();
  for (const StreetPlace& place : findings.places) {
    json["places"].push_back(
        {{"map_origin_latitude_deg", rounded(place.map_origin.latitude_deg, 1e9)},
         {"map_origin_longitude_deg", rounded(place.map_origin.longitude_deg, 1e9)},
         {"x_from_east_rad", rounded(place.x_from_east_rad, 1e4)},
         {"probability", rounded(place.probability, 1e4)},
         {"share_on_streets", rounded(place.share, 1e4)}});
  }
  return json.dump(2);
}

}  // namespace slammot::files
