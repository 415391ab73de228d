#pragma once

#include <vector>

#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"
#include "common/matching/correlative.hpp"
#include "services/loop_closing/place.hpp"
#include "services/loop_closing/registration.hpp"

namespace slammot::loop_closing {

struct RevisitConfig {
  double search_cell_m = 0.4;            ///< Step of the search.
  double min_score = 0.35;               ///< Of the search, before refinement.
  int max_peaks = 4;                     ///< Poses of one search that are looked at.
  int max_points = 600;                  ///< Surfels of the new submap that take part in the search.
  double window_sigmas = 3.0;            ///< How far around the expected pose is searched,
  double min_window_m = 2.0;             ///< at least
  double max_window_m = 30.0;            ///< and at most.
  double min_window_rad = 0.06;
  double max_window_rad = 0.6;
  double any_heading_sigma_rad = 1.0;    ///< Less sure of the heading than this, all of the circle is searched,
  double astray_window_m = 60.0;         ///< and at most so far around.
  double min_overlap_share = 0.3;        ///< Walls of both seen by the other.
  double min_agreed_share = 0.9;         ///< Of the walls about which the other knows anything.
  double min_agreed_in_support = 0.8;    ///< Searched for everywhere, so much still speaks for another that agrees.
  double rival_ratio = 0.75;             ///< Another pose that is as good as this share of the best makes it ambiguous.
  RegistrationConfig registration;
};

/// One way in which a new submap may lie on an earlier one.
struct Hypothesis {
  flow::SubmapId from;                   ///< The earlier submap.
  flow::SubmapId to;                     ///< The new one.
  geometry::UncertainPose2 from_to;
  Agreement agreement;
  double score = 0.0;                    ///< Of the search.
  bool has_rivals = false;               ///< Other poses fit about as well, and are not the same within the covariance.
  double searched_sigma_m = 0.0;         ///< How unsure the expected pose was.

  double quality() const { return agreement.agreed_share() * agreement.overlap_share(); }
};

/// Looks for the source in the target within the uncertainty of the expected pose. All poses that hold, best first;
/// empty when it is not there. The hypotheses are between the target's first member and the source.
class RevisitFinder {
 public:
  explicit RevisitFinder(const RevisitConfig& config);
  std::vector<Hypothesis> find(const Target& target, const Place& source, const geometry::UncertainPose2& expected_target_from_source);

 private:
  std::vector<matching::Peak> search(const Target& target, const Place& source, const geometry::UncertainPose2& expected);

  RevisitConfig config_;
  matching::CorrelativeMatcher matcher_;
};

}  // namespace slammot::loop_closing
