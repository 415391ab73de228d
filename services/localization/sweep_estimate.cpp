#include "services/localization/sweep_estimate.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "common/matching/robust_weight.hpp"

namespace slammot::localization {
namespace {

constexpr double kMapMadeWithinS = 2.0;
constexpr double kMemoryS = 20.0;

}  // namespace

SweepFactor learned(const SweepFactor& before, const SweptScan& scan,
                    const grids::SurfelMap& surfels, const matching::PointToLineConfig& config,
                    double variance_at_start) {
  if (before.variance <= 0.0) return before;
  SweepFactor after = before;
  const Eigen::Vector2d mapped_motion = before.mapped_motion.value_or(scan.motion);
  const Eigen::Vector2d change = scan.motion - mapped_motion;
  after.mapped_motion = mapped_motion + (1.0 - std::exp(-scan.after_s / kMapMadeWithinS)) * change;
  after.variance = std::min(variance_at_start, before.variance * std::exp(scan.after_s / kMemoryS));
  const geometry::Matrix2 turn = geometry::rotation(scan.map_from_base.heading_rad);
  const int radius = std::max(
      1, static_cast<int>(std::ceil(config.fine_gate_m / surfels.window().cell_size_m - 0.5)));
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();  // of (x, y, heading, factor)
  Eigen::Vector4d g = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const geometry::Vector2& in_base_m = scan.points[i].in_base_m;
    const geometry::Vector2 turned_m = turn * in_base_m;
    const auto surface =
        surfels.nearest_surface(turned_m + scan.map_from_base.translation_m(), radius);
    if (!surface || surface->normal.isZero()) continue;
    const geometry::Vector2 offset_m =
        turned_m + scan.map_from_base.translation_m() - surface->mean_m;
    if (offset_m.squaredNorm() > config.fine_gate_m * config.fine_gate_m) continue;
    const double residual_m = surface->normal.dot(offset_m);
    const geometry::Vector2 motion_mps(change.x() - change.y() * in_base_m.y(),
                                       change.y() * in_base_m.x());
    Eigen::Vector4d J;
    J << surface->normal, surface->normal.y() * turned_m.x() - surface->normal.x() * turned_m.y(),
        scan.share_of_sweep[i] * scan.sweep_s * surface->normal.dot(turn * motion_mps);
    const double weight = config.information_share *
                          matching::robust_weight(residual_m, config.robust_scale_m) /
                          (scan.points[i].sigma_m * scan.points[i].sigma_m + surface->spread_m2);
    H += weight * J * J.transpose();
    g += weight * residual_m * J;
  }
  H.topLeftCorner<3, 3>() += scan.prior_information;
  const Eigen::Vector3d cross = H.topRightCorner<3, 1>();
  const double information = H(3, 3) - cross.dot(H.topLeftCorner<3, 3>().ldlt().solve(cross));
  if (!(information > 0.0)) return after;
  after.variance = 1.0 / (1.0 / after.variance + information);
  after.value -= after.variance * g(3);  // the pose is where its own gradient vanishes
  return after;
}

}  // namespace slammot::localization
