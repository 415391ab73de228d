#include "common/graphs/place_of_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::Vector2;

constexpr std::size_t kMostFixes = 500;
constexpr std::size_t kProposals = 200;
constexpr std::size_t kRefined = 12;
constexpr double kFarShare = 0.3;  // of the extent: pairs of a proposal lie farther apart
/// Usual errors of receivers: with corrections, under an open sky, between houses.
constexpr std::array<double, 3> kUsualSigmas_m{0.4, 1.5, 4.0};

std::vector<Fix> thinned(std::span<const Fix> fixes) {
  const std::size_t stride = (fixes.size() + kMostFixes - 1) / kMostFixes;
  std::vector<Fix> kept;
  double way_m = 0.0;
  for (std::size_t i = 0; i < fixes.size(); ++i) {
    way_m += fixes[i].way_m;
    if (i % stride != 0) continue;
    kept.push_back(fixes[i]);
    kept.back().way_m = way_m;
    way_m = 0.0;
  }
  return kept;
}

/// The pose that two positions give.
Pose2 pose_of(const Fix& a, const Fix& b) {
  const Vector2 in_map_m = b.in_map_m - a.in_map_m;
  const Vector2 in_enu_m = b.in_enu_m - a.in_enu_m;
  const double turn_rad = geometry::wrap_angle(std::atan2(in_enu_m.y(), in_enu_m.x()) -
                                               std::atan2(in_map_m.y(), in_map_m.x()));
  const Vector2 middle_m = 0.5 * (a.in_enu_m + b.in_enu_m) -
                           geometry::rotation(turn_rad) * (0.5 * (a.in_map_m + b.in_map_m));
  return {middle_m.x(), middle_m.y(), turn_rad};
}

/// Greatest difference of two poses, anywhere on the drive.
double apart_m(const Pose2& a, const Pose2& b, const Extent& extent) {
  return (a * extent.middle_m - b * extent.middle_m).norm() +
         0.5 * extent.size_m * std::abs(geometry::wrap_angle(a.heading_rad - b.heading_rad));
}

struct Proposal {
  Pose2 enu_from_map;
  double log_likelihood = 0.0;
};

/// The best of poses by pairs of fixes that lie far apart, no two of them alike.
std::vector<Pose2> proposals(const std::vector<Fix>& fixes, const Extent& extent) {
  constexpr double kApart_m = 4.0;
  std::uint64_t state = 1;  // the generator of Knuth's MMIX
  const auto draw = [&] {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(state >> 33) % fixes.size();
  };
  std::vector<Proposal> all;
  for (std::size_t i = 0; i < kProposals; ++i) {
    const Fix& a = fixes[draw()];
    const Fix& b = fixes[draw()];
    if ((a.in_map_m - b.in_map_m).norm() < kFarShare * extent.size_m) continue;
    const Pose2 pose = pose_of(a, b);
    all.push_back({pose, likelihood(fixes, pose, {.usual_sigma_m = kUsualSigmas_m[1]}).logarithm});
  }
  std::ranges::stable_sort(all, std::greater{}, &Proposal::log_likelihood);
  std::vector<Pose2> best;
  for (const Proposal& proposal : all) {
    const bool is_new = std::ranges::none_of(best, [&](const Pose2& known) {
      return apart_m(known, proposal.enu_from_map, extent) < kApart_m;
    });
    if (is_new) best.push_back(proposal.enu_from_map);
    if (best.size() == kRefined) break;
  }
  return best;
}

Pose2 moved(const Pose2& pose, const Eigen::Vector3d& change) {
  return {pose.x_m + change.x(), pose.y_m + change.y(),
          geometry::wrap_angle(pose.heading_rad + change.z())};
}

/// A maximum near a pose.
struct Maximum {
  Pose2 enu_from_map;
  FixLikelihood likelihood;
};

Matrix3 information_of(const FixLikelihood& likelihood) {
  constexpr double kPriorSigma_m = 1e3;
  Matrix3 information = likelihood.information;
  information.diagonal() += Eigen::Vector3d(1.0, 1.0, 1.0) / (kPriorSigma_m * kPriorSigma_m);
  return information;
}

Maximum refined(const std::vector<Fix>& fixes, const Pose2& from, const FixErrorModel& model) {
  constexpr int kSteps = 12;
  constexpr double kLeastShare = 0.1;
  constexpr double kEnough = 1e-3;  // of the logarithm
  Maximum best{from, likelihood(fixes, from, model)};
  double share = 1.0;
  for (int step = 0; step < kSteps && share > kLeastShare; ++step) {
    const Eigen::Vector3d change =
        share * information_of(best.likelihood).ldlt().solve(best.likelihood.gradient);
    const Pose2 pose = moved(best.enu_from_map, change);
    const FixLikelihood there = likelihood(fixes, pose, model);
    const double gain = there.logarithm - best.likelihood.logarithm;
    if (gain < 0.0) {
      share *= 0.4;
      continue;
    }
    best = {pose, there};
    if (gain < kEnough) break;
  }
  return best;
}

/// Distinct maxima under one model; weights are logarithms.
void add_modes(const std::vector<Fix>& fixes, const std::vector<Pose2>& from, const Extent& extent,
               const FixErrorModel& model, std::vector<PlaceMode>& modes) {
  constexpr double kSame_m = 1.0;
  const std::size_t first = modes.size();
  for (const Pose2& pose : from) {
    const Maximum maximum = refined(fixes, pose, model);
    const bool is_known =
        std::any_of(modes.begin() + static_cast<std::ptrdiff_t>(first), modes.end(),
                    [&](const PlaceMode& known) {
                      return apart_m(known.enu_from_map, maximum.enu_from_map, extent) < kSame_m;
                    });
    if (is_known) continue;
    const Matrix3 covariance = information_of(maximum.likelihood).inverse();
    modes.push_back({maximum.enu_from_map, covariance,
                     maximum.likelihood.logarithm + 0.5 * std::log(covariance.determinant())});
  }
}

/// Weights from their logarithms.
void normalize(std::vector<PlaceMode>& modes) {
  constexpr double kLeast = 1e-4;
  std::ranges::stable_sort(modes, std::greater{}, &PlaceMode::weight);
  const double most = modes.front().weight;
  double sum = 0.0;
  for (PlaceMode& mode : modes) sum += mode.weight = std::exp(mode.weight - most);
  for (PlaceMode& mode : modes) mode.weight /= sum;
  std::erase_if(modes, [](const PlaceMode& mode) { return mode.weight < kLeast; });
}

}  // namespace

Extent extent_of(std::span<const Fix> fixes) {
  Vector2 low = fixes.front().in_map_m;
  Vector2 high = low;
  for (const Fix& fix : fixes) {
    low = low.cwiseMin(fix.in_map_m);
    high = high.cwiseMax(fix.in_map_m);
  }
  return {0.5 * (low + high), (high - low).norm()};
}

std::vector<PlaceMode> place_of_map(std::span<const Fix> fixes) {
  std::vector<PlaceMode> modes;
  if (fixes.size() < 2) return modes;
  const std::vector<Fix> kept = thinned(fixes);
  const Extent extent = extent_of(kept);
  const std::vector<Pose2> from = proposals(kept, extent);
  for (const double sigma_m : kUsualSigmas_m)
    add_modes(kept, from, extent, {.usual_sigma_m = sigma_m}, modes);
  if (!modes.empty()) normalize(modes);
  return modes;
}

Matrix3 spread_about(const Pose2& enu_from_map, std::span<const PlaceMode> modes) {
  Matrix3 spread = Matrix3::Zero();
  for (const PlaceMode& mode : modes) {
    const Eigen::Vector3d away = geometry::difference(mode.enu_from_map, enu_from_map);
    spread += mode.weight * (mode.covariance + away * away.transpose());
  }
  return spread;
}

}  // namespace slammot::graphs
