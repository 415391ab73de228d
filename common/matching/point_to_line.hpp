#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/surfel_map.hpp"
#include "common/work/side_work.hpp"

namespace slammot::matching {

/// One point of the scan with the standard deviation of its position across the surface.
struct MatchPoint {
  geometry::Vector2 in_base_m;
  double sigma_m = 0.03;
};

struct PointToLineConfig {
  int coarse_steps = 4;            ///< Gauss-Newton steps with the wide gate,
  int fine_steps = 8;              ///< then with the narrow one.
  double coarse_gate_m = 0.6;      ///< Points farther than this from the nearest surfel do not count.
  double fine_gate_m = 0.2;
  double proven_after_m = 2.0;     ///< A surfel counts in full once it was seen from places this far apart.
  double unproven_share = 0.02;    ///< Before, this much: what moves along with the vehicle looks as if it stood nearby.
  double new_below_m = 2.0;        ///< A surfel first seen less than this much of way ago is new: it does not change the match.
  double robust_scale_m = 0.05;    ///< Residual at which a point's weight has fallen to a quarter.
  double coarse_prior_sigmas = 0.0;  ///< In the steps with the wide gate, what so many sigmas of the prior put off the surface widens that scale: it is no outlier yet.
  double information_share = 0.10; ///< Points of one scan share the map's error: together they count for this share.
  double body_sigma_m = 0.0;       ///< One sigma of an error that all points of one body have in common; 0: none, each point counts for itself.
  double body_length_m = 5.0;      ///< A run of neighbouring points this long may be one body: a car at least.
  double converged_m = 1e-4;
};

struct PointToLineResult {
  geometry::UncertainPose2 map_from_base;
  Eigen::Matrix3d scan_information = Eigen::Matrix3d::Zero();  ///< What the points alone say, shared error included.
  int matched_points = 0;
  double matched_share = 0.0;      ///< Of the points given.
  double rms_residual_m = 0.0;     ///< Of the matched points, across the surface.
  double new_share = 0.0;          ///< Of the matched points, those on surfels first seen less than new_below_m of way ago.
};

/// Share of the points that lie on surfels, each by how near: half where residuals are as large as robust_scale_m. In [0, 1].
double fit_of(const PointToLineResult& registered, double robust_scale_m);

/// Registers points against surfels by Gauss-Newton on point-to-line distances with a Gaussian prior; Wang 2004,
/// section 3.2.1 describes the closed-form ICP that this replaces. Where a surfel has no direction the distance to its
/// mean counts. Holds nothing from one match to the next but memory.
/// With body_sigma_m the points of each body (a run of points with no gap between them; points in the order of the beams) share an
/// error b ~ N(0, body_sigma_m^2), for the body may be moving: n of variance v count for 1 / (v + n body_sigma_m^2) each. All are then scaled
/// so that the scan counts for as much as without: what many points on something near say in excess goes to all others.
class PointToLineMatcher {
 public:
  /// help (null: none) must outlive this; the results are the same with it and without.
  explicit PointToLineMatcher(work::SideWork* help = nullptr) : help_(help) {}

  /// The iteration starts at initial_map_from_base. The result is the prior when nothing matches.
  PointToLineResult match(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                          const geometry::UncertainPose2& prior_map_from_base,
                          const geometry::Pose2& initial_map_from_base, const PointToLineConfig& config);

 private:
  struct Pair {
    geometry::Vector2 in_base_m;
    geometry::Vector2 mean_m;
    geometry::Vector2 normal;
    double information_per_m2 = 0.0;
    double variance_m2 = 0.0;       ///< Of the point to the surfel,
    double share = 1.0;             ///< and what a surfel that is not proven counts for: information is their quotient.
    bool has_direction = false;
    bool is_new = false;
  };
  struct NormalEquations {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    int matched = 0;
    int matched_new = 0;
    double squared_residuals_m2 = 0.0;

  };

  void pair(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels, const geometry::Pose2& map_from_base,
            double gate_m, const PointToLineConfig& config);
  void share_errors_of_bodies(const PointToLineConfig& config);
  /// expected: covariance of (x [m], y [m], heading [rad]) that residuals are allowed before they count as outliers; none: nothing beyond robust_scale_m.
  NormalEquations linearize(const geometry::Pose2& map_from_base, double gate_m, const std::optional<geometry::Matrix3>& expected, const PointToLineConfig& config) const;

  work::SideWork* help_;
  std::vector<std::size_t> places_;       ///< Of the surfel nearest to each point, if there is one.
  std::vector<Pair> pairs_;
};

}  // namespace slammot::matching
