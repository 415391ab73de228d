#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/uncertain_pose2.hpp"
#include "common/grids/surfel_map.hpp"
#include "common/matching/match_point.hpp"
#include "common/work/side_work.hpp"

namespace slammot::matching {

struct PointToLineConfig {
  int coarse_steps = 4;        ///< Gauss-Newton steps with the wide gate,
  int fine_steps = 8;          ///< then with the narrow one.
  double coarse_gate_m = 0.6;  ///< Points farther than this from the nearest surfel are ignored.
  double fine_gate_m = 0.2;
  double proven_after_m = 2.0;   ///< A surfel has full weight once it was seen from places this far
                                 ///< apart.
  double unproven_share = 0.02;  ///< Weight of a surfel before that: an object that moves with the
                                 ///< vehicle looks stationary.
  double new_below_m = 2.0;  ///< A surfel first seen less than this way ago is new; this does not
                             ///< affect the match.
  double robust_scale_m = 0.05;      ///< Residual at which a point's weight is a quarter.
  double coarse_prior_sigmas = 0.0;  ///< With the wide gate, robust_scale_m grows by this many
                                     ///< sigmas of the prior across the surface.
  double information_share = 0.10;   ///< Points of one scan share the map's error: their total
                                     ///< information is scaled by this.
  double body_sigma_m = 0.0;  ///< One sigma of an error common to all points of one body; 0: points
                              ///< are independent.
  double body_length_m = 5.0;  ///< A run of neighbouring points this long may be one body: at least
                               ///< a car.
  double open_heading_rad = 0.006;  ///< Objects that stand alone tell of the heading where surfaces
                                    ///< leave it open by this, one sigma.
  double converged_m = 1e-4;
};

struct PointToLineResult {
  geometry::UncertainPose2 map_from_base;
  Eigen::Matrix3d scan_information = Eigen::Matrix3d::Zero();  ///< Information of the points
                                                               ///< without the prior, with the
                                                               ///< shared error.
  int matched_points = 0;
  double matched_share = 0.0;   ///< Share of the given points.
  double rms_residual_m = 0.0;  ///< Over the matched points, across the surface.
  double new_share = 0.0;  ///< Share of the matched points that lie on surfels first seen less than
                           ///< new_below_m of way ago.
};

/// Cells around a point's in which surfels within the gate are looked for.
int search_radius(const grids::SurfelMap& surfels, double gate_m);

/// Share of the points that lie on surfels, in [0, 1]. A point's weight decreases with its
/// residual: half at robust_scale_m.
double fit_of(double matched_share, double rms_residual_m, double robust_scale_m);
double fit_of(const PointToLineResult& registered, double robust_scale_m);

/// Registers points to surfels by Gauss-Newton on point-to-line distances with a Gaussian prior. It
/// replaces the closed-form ICP of Wang 2004, section 3.2.1. For a surfel without direction the
/// distance to its mean counts. Where surfaces leave the heading open, and there are several of
/// them, a point of a whole object that stands alone in the map tells of the direction along its
/// surface, too: the object's echoes lie about its mean with the variance of its extent, as in the
/// normal distributions transform (Biber and Strasser 2003), and share an error, since it may be
/// seen from another side. Of a wall, whose surfels have neighbours, they would pull towards the
/// middle of each cell. No state but memory is kept between matches. With body_sigma_m the
/// points of each body share a displacement b ~ N(0, body_sigma_m^2 I), since the body may be
/// moving. A body is a run of points without a gap, in the order of the beams. A point i of
/// variance v has the weight 1 / (v + m body_sigma_m^2), where m = sum over the body's points j of
/// (n_i . n_j)^2: as many of them tell of its normal's direction. That is exact for normals that
/// are parallel or perpendicular. All weights are then scaled so that the scan's total is
/// unchanged: a near body with many points loses weight to all others, the corner of a long wall
/// does not.
class PointToLineMatcher {
 public:
  /// help (may be null) must outlive this; results do not depend on it.
  explicit PointToLineMatcher(work::SideWork* help = nullptr) : help_(help) {}

  /// Iterates from initial_map_from_base. Returns the prior if nothing matches.
  PointToLineResult match(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
                          const geometry::UncertainPose2& prior_map_from_base,
                          const geometry::Pose2& initial_map_from_base,
                          const PointToLineConfig& config);

 private:
  struct Pair {
    geometry::Vector2 in_base_m;
    geometry::Vector2 mean_m;
    geometry::Vector2 normal;
    double information_per_m2 = 0.0;
    double variance_m2 = 0.0;  ///< Of the distance between point and surfel.
    double share = 1.0;  ///< Weight of an unproven surfel; the information is share / variance_m2.
    bool has_direction = false;
    bool is_new = false;
    std::uint32_t point = 0;   ///< Index of the point,
    std::int32_t object = -1;  ///< and in objects_, if it is of a whole object that stands alone.

    geometry::Vector2 along() const { return {-normal.y(), normal.x()}; }
  };
  /// Tells where along the surface a point is.
  struct Object {
    geometry::Vector2 mean_m = geometry::Vector2::Zero();
    double extent_m2 = 0.0;           ///< Variance of its echoes along it.
    double information_per_m2 = 0.0;  ///< Of the distance of the point from its mean.
  };
  struct NormalEquations {
    Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();
    int matched = 0;
    int matched_new = 0;
    double squared_residuals_m2 = 0.0;
  };

  void pair(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels,
            const geometry::Pose2& map_from_base, double gate_m, const PointToLineConfig& config);
  void find_objects(const std::vector<MatchPoint>& points, const grids::SurfelMap& surfels);
  void share_errors_of_bodies(const PointToLineConfig& config);
  bool leaves_heading_open(const geometry::Pose2& map_from_base, double gate_m,
                           const PointToLineConfig& config) const;
  /// expected: covariance of (x [m], y [m], heading [rad]) by which the robust scale grows; none:
  /// the scale is robust_scale_m.
  NormalEquations linearize(const geometry::Pose2& map_from_base, double gate_m,
                            const std::optional<geometry::Matrix3>& expected,
                            const PointToLineConfig& config) const;

  work::SideWork* help_;
  std::vector<std::size_t> places_;  ///< Index of the surfel nearest to each point, if any.
  std::vector<Pair> pairs_;
  std::vector<Object> objects_;  ///< Empty where surfaces tell the heading.
};

}  // namespace slammot::matching
