#pragma once

#include <vector>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "services/loop_closing/place.hpp"

namespace slammot::loop_closing {

inline constexpr double kSameWithinSquaredSigmas = 11.3;  ///< Chi-square, 3 degrees of freedom, 99
                                                          ///< %.

/// One possible pose of a new submap on an earlier one.
struct Hypothesis {
  flow::SubmapId from;  ///< The earlier submap.
  flow::SubmapId to;    ///< The new submap.
  geometry::UncertainPose2 from_to;
  Agreement agreement;
  double score = 0.0;       ///< Of the search, in [0, 1].
  bool has_rivals = false;  ///< Other poses fit about as well and differ by more than the
                            ///< covariance.
  double certainty = 1.0;   ///< Its share among the poses that its submap may have, by quality.
  double searched_sigma_m = 0.0;  ///< One sigma of the expected position.

  double quality() const { return agreement.agreed_share() * agreement.overlap_share(); }
};

/// True if one has clearly more contradictions than another that fits as well or nearly so. In
/// repetitive corridors most walls agree at any pose, so that only contradictions distinguish the
/// poses.
bool is_more_contradicted(const Hypothesis& one, const Hypothesis& other);

/// Drops duplicates, contradicted and poor hypotheses on one target; best first. Several that
/// remain compete with each other.
void select_on_one_target(std::vector<Hypothesis>& hypotheses, double rival_ratio);

/// Drops hypotheses on several targets that are clearly worse than the best one. In repetitive
/// corridors most walls agree at any pose, so that only contradictions distinguish the poses.
void drop_clearly_worse(std::vector<Hypothesis>& hypotheses, double rival_ratio);

}  // namespace slammot::loop_closing
