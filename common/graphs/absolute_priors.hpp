#pragma once

#include <optional>
#include <span>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/ids.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::graphs {

/// Measured position of a point of a node, in a local frame `enu` with x to the east and y to the
/// north.
struct PositionPrior {
  flow::SubmapId node;
  geometry::Vector2 in_node_m;
  geometry::Vector2 in_enu_m;
  geometry::Matrix2 covariance_m2;  ///< As claimed; the true scale is estimated.
};

/// Measured heading of a direction of a node. All readings share one unknown bias.
struct HeadingPrior {
  flow::SubmapId node;
  double in_node_rad = 0.0;
  double in_enu_rad = 0.0;  ///< Counter-clockwise from east.
  double sigma_rad = 0.0;   ///< As claimed; the true scale is estimated.
};

/// In the order in which they were measured: the correlation of successive errors is estimated.
struct AbsolutePriors {
  std::vector<PositionPrior> positions;
  std::vector<HeadingPrior> headings;
};

/// How well measurements of one kind agree with the graph.
struct PriorAgreement {
  std::vector<bool> is_inlier;  ///< Of each.
  double scale = 1.0;           ///< Of the claimed sigmas, at least 1.
  double correlated = 1.0;      ///< Number of successive measurements that count as one.

  std::size_t inliers() const;
};

/// Graph and local frame `enu` in the relation that the priors suggest.
struct AbsoluteFit {
  geometry::Pose2 enu_from_map;
  bool has_position = false;      ///< False without positions that agree.
  bool has_direction = false;     ///< False if neither positions nor headings determine it.
  double position_sigma_m = 0.0;  ///< Of the map's origin, per axis.
  double direction_sigma_rad = 0.0;
  double heading_bias_rad = 0.0;
  PriorAgreement positions;
  PriorAgreement headings;
};

/// Rigid alignment of the nodes to the priors. Positions: the likeliest of the places that
/// `place_of_map` finds; multipath that lasts is part of the model, and the sigmas contain what
/// other places are likely. Inliers are the fixes within 3 sigmas of the scale of their errors.
/// Headings: least median of squares (Rousseeuw 1984), then the mean of the inliers, of which there
/// must be more than half; they count against a bias of unknown size: with positions it is
/// estimated, without it is assumed to be small.
AbsoluteFit align(const std::vector<flow::CorrectedSubmap>& nodes, const AbsolutePriors& priors);

/// Poses of the nodes by constraints and priors together.
struct BentGraph {
  std::vector<flow::CorrectedSubmap> nodes;
  AbsoluteFit fit;
  double cost_saved = 0.0;  ///< By bending, of the sum of squared errors of constraints and
                            ///< inliers.
};

/// Least squares over constraints and the inliers of a fit; the first node is fixed, enu_from_map
/// and the bias are estimated. Precondition: the fit has a position or a direction. None if the
/// solver fails.
std::optional<BentGraph> bend(const std::vector<flow::CorrectedSubmap>& nodes,
                              std::span<const flow::Constraint> constraints,
                              const AbsolutePriors& priors, const AbsoluteFit& fit);

}  // namespace slammot::graphs
