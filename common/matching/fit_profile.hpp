#pragma once

#include <span>
#include <vector>

#include "common/grids/surfel_map.hpp"
#include "common/matching/point_to_line.hpp"

namespace slammot::matching {

/// How well the points lie on the surfels at each of several positions with one heading: fit_of() a
/// registration with one fine step from there. Positions should be sorted along a line: the surfels
/// around a point are looked up once a cell, and nothing is computed that only a step needs. 18
/// positions cost a third of the instructions of 18 registrations.
std::vector<double> fits_at(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                            double heading_rad, std::span<const geometry::Vector2> positions_m,
                            const PointToLineConfig& config);

}  // namespace slammot::matching
