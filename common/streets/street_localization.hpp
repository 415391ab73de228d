#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/seen_space.hpp"
#include "common/streets/street_graph.hpp"
#include "common/streets/street_proposals.hpp"

namespace slammot::streets {

struct StreetLocalizationConfig {
  double node_sigma_m = 1.5;   ///< Of a junction of the graph, an axis, one sigma: digitization.
  double lane_sigma_m = 2.0;   ///< Of the lane's distance from the line: estimated.
  double least_way_m = 100.0;  ///< Less tells nothing.
  double clear_probability = 0.99;  ///< Of the best place, for it to count as located.
};

enum class StreetVerdict {
  kTooShort,      ///< The way is shorter than least_way_m.
  kNotOnStreets,  ///< No place fits: the vehicle drives where the graph has no streets.
  kAmbiguous,     ///< Several places fit.
  kLocated,
};

/// A place where the way fits.
struct StreetFit {
  geometry::Pose2 streets_from_map;
  double cost = 0.0;         ///< Negative logarithm of the evidence.
  double share = 0.0;        ///< Of the way on streets.
  double probability = 0.0;  ///< Among all places that were found.
  int missing = 0;           ///< Streets of the way that the graph lacks there.
};

struct StreetLocation {
  StreetVerdict verdict = StreetVerdict::kTooShort;
  double way_m = 0.0;
  std::vector<StreetFit> fits;  ///< Best first; at most 20, none for a way that is too short.
};

/// Finds where in a street graph a way was driven: topological global localization with a digital
/// map (Wang, Thorpe and Thrun 2003, section III). The way comes from the scans and is accurate in
/// shape, so that it is compared with the streets as a whole. Each place has an evidence, with the
/// errors of the graph integrated out, and streets may be missing at a cost (street_evidence.hpp).
///
/// way: poses map_from_base in the order of the drive, of any spacing. start: none if nothing is
/// known. Deterministic.
StreetLocation locate(const StreetGraph& graph, std::span<const geometry::Pose2> way,
                      const std::optional<StartArea>& start,
                      const StreetLocalizationConfig& config = {}, const SeenSpace& seen = {});

/// What was found on the way, as it was driven.
struct StreetSearch {
  std::optional<double> located_after_m;  ///< Of the way; none if it never was.
  StreetLocation location;                ///< After that way; if it never was located, at the end.
};

/// Searches with the first 100 m of the way, then with 50 m more each time, up to `most_m`, until
/// one place is clear.
StreetSearch search_along(const StreetGraph& graph, std::span<const geometry::Pose2> way,
                          const std::optional<StartArea>& start, double most_m,
                          const StreetLocalizationConfig& config = {}, const SeenSpace& seen = {});

}  // namespace slammot::streets
