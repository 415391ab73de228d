#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/pose2.hpp"
#include "common/streets/driven_way.hpp"
#include "common/streets/missing_streets.hpp"
#include "common/streets/side_streets.hpp"
#include "common/streets/street_field.hpp"
#include "common/streets/street_network.hpp"

namespace slammot::streets {

/// What is known before the comparison, one sigma each.
struct StreetPrior {
  double node_sigma_m = 1.5;       ///< Of each node of the graph, an axis: digitization.
  double lane_sigma_m = 2.0;       ///< Of the lane's distance from the line.
  double place_sigma_m = 70.0;     ///< Of the way's place, an axis.
  double heading_sigma_rad = 1.8;  ///< Of its direction.
};

/// How a place explains the way.
struct Explanation {
  geometry::Pose2 streets_from_map;
  double cost = 0.0;     ///< Negative logarithm of the evidence, beside that of known lines.
  double squares = 0.0;  ///< The part of it that is due to errors.
  double share = 0.0;    ///< Of the way on streets.
  int missing = 0;       ///< Streets that the graph lacks.
  std::vector<Piece> pieces;
};

/// Evidence of a place: the likelihood of the way, with the place itself, the lane and the errors
/// of the graph's nodes integrated out. Between two nodes a street has their errors in proportion,
/// so that its points do not err independently. What lies beside all streets is explained by
/// missing streets.
class StreetEvidence {
 public:
  /// fans: what was seen beside the way; none if that is unknown.
  StreetEvidence(const StreetNetwork& network, const StreetField& field, const DrivenWay& way,
                 const StreetPrior& prior, std::vector<ViewFan> fans = {})
      : network_(network),
        field_(field),
        way_(way),
        prior_(prior),
        sides_(network, std::move(fans)) {}

  /// Explanation near a place by the streets around it.
  Explanation explain(const geometry::Pose2& streets_from_map) const;

  /// Takes streets that fit badly for others, which are missing, as long as that is more probable.
  Explanation with_missing_streets(const Explanation& by_all_streets) const;

  /// The whole way beside the streets, at no place.
  Explanation beside_all_streets() const;

 private:
  Explanation settled(geometry::Pose2 streets_from_map, const std::vector<bool>& is_beside) const;
  std::vector<Piece> pieces_at(const geometry::Pose2& streets_from_map,
                               const std::vector<bool>& is_beside) const;
  std::optional<std::size_t> link_at(const geometry::Pose2& streets_from_base) const;

  const StreetNetwork& network_;
  const StreetField& field_;
  const DrivenWay& way_;
  StreetPrior prior_;
  SideStreets sides_;
};

}  // namespace slammot::streets
