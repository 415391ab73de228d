#include "common/matching/point_to_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "common/geometry/displacement.hpp"
#include "common/matching/body.hpp"
#include "common/matching/robust_weight.hpp"

namespace slammot::matching {
namespace {

using geometry::Matrix3;
using geometry::Pose2;

constexpr double kSamePairsWithin = 0.01;  ///< As a share of a surfel's cell: a pose change below
                                           ///< it keeps the correspondences.
constexpr double kWidestInCells = 2.4;     ///< Objects that fit into the 3 x 3 cells around a
                                           ///< surfel's.
constexpr double kExtents = 2.0;  ///< An object's echoes are within so many sigmas of its extent.
constexpr double kSeenFromWithin_m = 5.0;  ///< The way on which a surfel's mean was made.
constexpr int kFewestObjects = 4;          ///< Of fewer, the error of one decides.

bool has_objects(const std::vector<MatchPoint>& points) {
  return std::ranges::any_of(points,
                             [](const MatchPoint& point) { return point.object_width_m > 0.0; });
}

/// The side of an object that is seen now is not that of which the map has the mean: an error of
/// its points that they share, up to half its width.
double variance_of_view_m2(const MatchPoint& point) {
  const double turned = std::min(1.0, kSeenFromWithin_m / point.in_base_m.norm());
  return point.object_points * std::pow(0.5 * point.object_width_m * turned, 2);
}

/// Of the heading where the position is unknown, by information about (x, y, heading) [1/rad^2].
double heading_information(const Matrix3& information) {
  const Eigen::Vector2d cross = information.topRightCorner<2, 1>();
  const geometry::Matrix2 of_position = information.topLeftCorner<2, 2>();
  if (!(of_position.determinant() > 0.0)) return 0.0;
  return information(2, 2) - cross.dot(of_position.ldlt().solve(cross));
}

}  // namespace

int search_radius(const grids::SurfelMap& surfels, double gate_m) {
  return std::max(1, static_cast<int>(std::ceil(gate_m / surfels.window().cell_size_m - 0.5)));
}

void PointToLineMatcher::pair(const std::vector<MatchPoint>& points,
                              const grids::SurfelMap& surfels, const Pose2& map_from_base,
                              double gate_m, const PointToLineConfig& config) {
  const int radius = search_radius(surfels, gate_m);
  const geometry::Matrix2 turn = geometry::rotation(map_from_base.heading_rad);
  places_.resize(points.size());
  constexpr std::size_t kRanges = 4;
  work::share_in_ranges(help_, points.size(), kRanges, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i)
      places_[i] =
          surfels.nearest_place(turn * points[i].in_base_m + map_from_base.translation_m(), radius);
  });
  pairs_.clear();
  objects_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MatchPoint& point = points[i];
    if (places_[i] == grids::SurfelMap::kNoPlace) continue;
    const grids::SurfelMap::Surface surface = surfels.surface_at(places_[i]);
    const bool has_direction = !surface.normal.isZero();
    // Without a direction the surface may be anywhere in its cell.
    const double variance_m2 =
        has_direction ? point.sigma_m * point.sigma_m + surface.spread_m2
                      : std::pow(point.sigma_m + 0.5 * surfels.window().cell_size_m, 2);
    const double share = surface.seen_over_m >= config.proven_after_m ? 1.0 : config.unproven_share;
    pairs_.push_back({point.in_base_m, surface.mean_m, surface.normal, share / variance_m2,
                      variance_m2, share, has_direction, surface.seen_over_m < config.new_below_m,
                      static_cast<std::uint32_t>(i)});
  }
  if (config.body_sigma_m > 0.0) share_errors_of_bodies(config);
}

void PointToLineMatcher::find_objects(const std::vector<MatchPoint>& points,
                                      const grids::SurfelMap& surfels) {
  const double widest_m = kWidestInCells * surfels.window().cell_size_m;
  int count = 0;
  for (Pair& pair : pairs_) {
    const MatchPoint& point = points[pair.point];
    const bool is_whole = point.object_width_m > 0.0 && point.object_width_m < widest_m;
    const bool is_proven = pair.share >= 1.0;
    if (!is_whole || !is_proven) continue;
    const std::optional<grids::LoneObject> object = surfels.lone_object_at(places_[pair.point]);
    if (!object) continue;
    const double variance_m2 =
        point.sigma_m * point.sigma_m + object->extent_m2 + variance_of_view_m2(point);
    count += objects_.empty() || (object->mean_m - objects_.back().mean_m).norm() > widest_m;
    pair.object = static_cast<std::int32_t>(objects_.size());
    objects_.push_back({object->mean_m, object->extent_m2, 1.0 / variance_m2});
  }
  if (count >= kFewestObjects) return;
  for (Pair& pair : pairs_) pair.object = -1;
}

void PointToLineMatcher::share_errors_of_bodies(const PointToLineConfig& config) {
  const double shared_m2 = config.body_sigma_m * config.body_sigma_m;
  const auto direction_of = [](const Pair& pair) -> geometry::Matrix2 {
    if (!pair.has_direction) return 0.5 * geometry::Matrix2::Identity();
    return pair.normal * pair.normal.transpose();
  };
  double each_for_itself = 0.0;
  double together = 0.0;
  for (std::size_t first = 0, end = 0; first < pairs_.size(); first = end) {
    end = end_of_body(pairs_, first, config.body_length_m);
    geometry::Matrix2 directions = geometry::Matrix2::Zero();
    for (std::size_t i = first; i < end; ++i) directions += direction_of(pairs_[i]);
    for (std::size_t i = first; i < end; ++i) {
      const double alike = direction_of(pairs_[i]).cwiseProduct(directions).sum();
      const double shared = 1.0 / (pairs_[i].variance_m2 + alike * shared_m2);
      each_for_itself += 1.0 / pairs_[i].variance_m2;
      together += shared;
      pairs_[i].information_per_m2 = shared * pairs_[i].share;
    }
  }
  for (Pair& pair : pairs_) pair.information_per_m2 *= each_for_itself / together;
}

PointToLineMatcher::NormalEquations PointToLineMatcher::linearize(
    const Pose2& map_from_base, double gate_m, const std::optional<Matrix3>& expected,
    const PointToLineConfig& config) const {
  const geometry::Matrix2 turn = geometry::rotation(map_from_base.heading_rad);
  NormalEquations equations;
  double xx = 0.0, xy = 0.0, xh = 0.0, yy = 0.0, yh = 0.0, hh = 0.0, x = 0.0, y = 0.0,
         h = 0.0;  // entries of J'WJ and J'Wr
  const auto robust_scale_m = [&](const geometry::Vector2& direction, double by_heading_m,
                                  double extent_m2) {
    if (!expected && extent_m2 == 0.0) return config.robust_scale_m;
    double scale_m2 = config.robust_scale_m * config.robust_scale_m;
    const Eigen::Vector3d by_pose(direction.x(), direction.y(), by_heading_m);
    if (expected) scale_m2 += by_pose.dot(*expected * by_pose);
    return std::sqrt(scale_m2 + kExtents * kExtents * extent_m2);
  };
  const auto add = [&](const geometry::Vector2& direction, double by_heading_m, double residual_m,
                       double information_per_m2, double extent_m2 = 0.0) {
    const double weight =
        robust_weight(residual_m, robust_scale_m(direction, by_heading_m, extent_m2)) *
        information_per_m2;
    const double weighted_x = weight * direction.x();
    const double weighted_y = weight * direction.y();
    const double weighted_h = weight * by_heading_m;
    xx += weighted_x * direction.x(), xy += weighted_x * direction.y(),
        xh += weighted_x * by_heading_m;
    yy += weighted_y * direction.y(), yh += weighted_y * by_heading_m,
        hh += weighted_h * by_heading_m;
    x += weighted_x * residual_m, y += weighted_y * residual_m, h += weighted_h * residual_m;
  };
  for (const Pair& pair : pairs_) {
    const geometry::Vector2 turned_m = turn * pair.in_base_m;
    const geometry::Vector2 offset_m = turned_m + map_from_base.translation_m() - pair.mean_m;
    if (offset_m.squaredNorm() > gate_m * gate_m) continue;
    ++equations.matched;
    if (pair.is_new) ++equations.matched_new;
    if (pair.has_direction) {
      const double residual_m = pair.normal.dot(offset_m);
      equations.squared_residuals_m2 += residual_m * residual_m;
      add(pair.normal, pair.normal.y() * turned_m.x() - pair.normal.x() * turned_m.y(), residual_m,
          pair.information_per_m2);
      if (pair.object < 0) continue;
      const Object& object = objects_[static_cast<std::size_t>(pair.object)];
      add(pair.along(), pair.normal.dot(turned_m),
          pair.along().dot(offset_m + pair.mean_m - object.mean_m), object.information_per_m2,
          object.extent_m2);
    } else if (pair.object >= 0) {
      const Object& object = objects_[static_cast<std::size_t>(pair.object)];
      const geometry::Vector2 from_mean_m = offset_m + pair.mean_m - object.mean_m;
      equations.squared_residuals_m2 += 0.5 * from_mean_m.squaredNorm();
      add({1.0, 0.0}, -turned_m.y(), from_mean_m.x(), object.information_per_m2, object.extent_m2);
      add({0.0, 1.0}, turned_m.x(), from_mean_m.y(), object.information_per_m2, object.extent_m2);
    } else {
      equations.squared_residuals_m2 += 0.5 * offset_m.squaredNorm();
      add({1.0, 0.0}, -turned_m.y(), offset_m.x(), pair.information_per_m2);
      add({0.0, 1.0}, turned_m.x(), offset_m.y(), pair.information_per_m2);
    }
  }
  equations.H << xx, xy, xh, xy, yy, yh, xh, yh, hh;
  equations.g << x, y, h;
  equations.H *= config.information_share;
  equations.g *= config.information_share;
  return equations;
}

/// Whether what surfaces tell of the heading is not enough. Where it is, objects do harm: their
/// errors last as long as they are in view.
bool PointToLineMatcher::leaves_heading_open(const Pose2& map_from_base, double gate_m,
                                             const PointToLineConfig& config) const {
  const double open_rad2 = config.open_heading_rad * config.open_heading_rad;
  return heading_information(linearize(map_from_base, gate_m, std::nullopt, config).H) * open_rad2 <
         1.0;
}

PointToLineResult PointToLineMatcher::match(const std::vector<MatchPoint>& points,
                                            const grids::SurfelMap& surfels,
                                            const geometry::UncertainPose2& prior_map_from_base,
                                            const Pose2& initial_map_from_base,
                                            const PointToLineConfig& config) {
  const Matrix3 prior_information = prior_map_from_base.covariance.inverse();
  const Pose2& prior = prior_map_from_base.pose;
  PointToLineResult result;
  result.map_from_base = prior_map_from_base;
  Pose2& pose = result.map_from_base.pose;
  pose = initial_map_from_base;
  std::optional<Matrix3> expected;
  if (config.coarse_prior_sigmas > 0.0)
    expected =
        config.coarse_prior_sigmas * config.coarse_prior_sigmas * prior_map_from_base.covariance;
  NormalEquations equations;
  double moved_since_paired_m = std::numeric_limits<double>::infinity();
  std::optional<bool> is_heading_open;
  for (int step = 0; step < config.coarse_steps + config.fine_steps; ++step) {
    const bool is_coarse = step < config.coarse_steps;
    const double gate_m = is_coarse ? config.coarse_gate_m : config.fine_gate_m;
    if (moved_since_paired_m > kSamePairsWithin * surfels.window().cell_size_m) {
      pair(points, surfels, pose, gate_m, config);
      if (!is_heading_open)
        is_heading_open = has_objects(points) && leaves_heading_open(pose, gate_m, config);
      if (*is_heading_open) find_objects(points, surfels);
      moved_since_paired_m = 0.0;
    }
    equations = linearize(pose, gate_m, is_coarse ? expected : std::nullopt, config);
    const Matrix3 H = equations.H + prior_information;
    const Eigen::Vector3d change =
        -H.ldlt().solve(equations.g + prior_information * geometry::difference(pose, prior));
    pose = geometry::displaced(pose, change);
    const double moved_m = geometry::as_seen_10_m_away(change);
    moved_since_paired_m += moved_m;
    if (moved_m < config.converged_m) {
      if (!is_coarse) break;
      step = config.coarse_steps - 1;
    }
  }
  if (equations.matched == 0) pose = prior;
  result.scan_information = equations.H;
  result.map_from_base.covariance = (equations.H + prior_information).inverse();
  result.matched_points = equations.matched;
  if (!points.empty())
    result.matched_share =
        static_cast<double>(equations.matched) / static_cast<double>(points.size());
  if (equations.matched > 0)
    result.new_share = static_cast<double>(equations.matched_new) / equations.matched;
  if (equations.matched > 0)
    result.rms_residual_m = std::sqrt(equations.squared_residuals_m2 / equations.matched);
  return result;
}

double fit_of(double matched_share, double rms_residual_m, double robust_scale_m) {
  const double scale_m2 = robust_scale_m * robust_scale_m;
  return matched_share * scale_m2 / (scale_m2 + rms_residual_m * rms_residual_m);
}

double fit_of(const PointToLineResult& registered, double robust_scale_m) {
  return fit_of(registered.matched_share, registered.rms_residual_m, robust_scale_m);
}

}  // namespace slammot::matching
