#include "services/tracking/object_class.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/geometry/squared.hpp"

namespace slammot::tracking {
namespace {

using flow::ClassProbabilities;

constexpr std::size_t kPedestrianEntry = entry_of(flow::ObjectClass::kPedestrian);
constexpr std::size_t kFirstVehicle = entry_of(flow::ObjectClass::kCar);

constexpr double kSpeedMemoryS = 6.0;     ///< For which a speed counts.
constexpr double kSpeedLastsS = 2.0;      ///< Correlation time of the speed.
constexpr double kSpeedProvenS = 1.0;     ///< For which a speed must be held to count as reached.
constexpr double kOutlierShare = 0.02;    ///< Of speeds of other objects,
constexpr double kOutlierDensity = 0.04;  ///< uniform up to 25 m/s.

/// By the entries of the class probabilities. Speeds while moving, normal; and the top speed, which
/// one in six exceeds.
struct SpeedRange {
  double speed_mps, sigma_mps, top_mps, top_sigma_mps;
};
constexpr std::array<SpeedRange, 4> kSpeedRanges = {
    {{1.35, 0.45, 2.3, 0.5}, {4.2, 1.7, 7.0, 1.5}, {8.0, 5.0, 60.0, 1.0}, {7.0, 4.5, 60.0, 1.0}}};

/// Prior of blobs; boxes have the shares of their kinds.
constexpr std::array<double, 4> kShares = {0.35, 0.09, 0.49, 0.07};
constexpr double kShareIndoors = 1e-6;  ///< Of vehicles.

/// Likelihood of a blob to have been seen whole, both ends at once, and for pedestrians the
/// distribution of their extents. Of a vehicle a part is visible behind an occluder, whose ends are
/// now and then taken for its own. Counted: docs/decisions/object-covariance.md.
constexpr double kPedestrianExtentM = 0.55;
constexpr double kPedestrianExtentSigmaM = 0.25;
constexpr std::array<double, 4> kDensityOfWhole = {1.0, 0.2, 0.01, 0.01};
/// The same if an end has always been hidden: pedestrians soon leave an occlusion.
constexpr std::array<double, 4> kDensityOfPiece = {0.03, 0.05, 0.2, 0.2};

/// Several pedestrians side by side or one behind the other, as large as a box.
const KindOfBody kCompany{Kind::kBicycle, 0.08, 1.3, 0.35, 0.6, 0.2};

using geometry::squared;

double normal_density(double offset, double sigma) {
  return std::exp(-0.5 * squared(offset / sigma)) / (sigma * std::sqrt(2.0 * std::numbers::pi));
}

double exceeded_share(double value, double mean, double sigma) {
  return 0.5 * std::erfc((value - mean) / (sigma * std::numbers::sqrt2));
}

/// Log-likelihood of both sizes under a kind.
double log_fit(const KindOfBody& kind, const SizeEvidence& length, const SizeEvidence& width,
               double scale) {
  return kind.log_share +
         log_likelihood_of_size(scale * kind.length_m, scale * kind.length_sigma_m, length, scale) +
         log_likelihood_of_size(scale * kind.width_m, scale * kind.width_sigma_if_askew_m, width,
                                scale);
}

ClassProbabilities log_fit_of_box(const Box& box, const TrackingConfig& config) {
  ClassProbabilities fit;
  fit.fill(-1e300);
  const EvidenceByKind evidence = evidence_by_kind(box, config);
  fit[kPedestrianEntry] = std::max(
      log_fit(kCompany, box.evidence.length, box.evidence.width, config.extent.size_scale),
      log_fit(kCompany, box.evidence.width, box.evidence.length, config.extent.size_scale));
  for (const KindOfBody& kind : box.road_users->kinds) {
    if (kind.share <= 0.0) continue;
    double& of_class = fit[entry_of(class_of(kind.kind))];
    of_class = log_sum(of_class, log_fit(kind, evidence.of(kind.kind).length,
                                         evidence.of(kind.kind).width, config.extent.size_scale));
  }
  return fit;
}

ClassProbabilities log_fit_of_blob(const Blob& blob, const TrackingConfig& config) {
  const double extent_m = blob.length.value_m / config.extent.size_scale;
  const auto& density = blob.was_seen_whole ? kDensityOfWhole : kDensityOfPiece;
  ClassProbabilities log_fit;
  for (std::size_t i = 0; i < log_fit.size(); ++i) {
    const double of_extent = i == kPedestrianEntry ? normal_density(extent_m - kPedestrianExtentM,
                                                                    kPedestrianExtentSigmaM)
                                                   : 1.0;
    log_fit[i] = std::log(kShares[i] * density[i] * of_extent + 1e-12);
  }
  return log_fit;
}

}  // namespace

SpeedsSeen with_first_speed(const SpeedHeld& held, const TrackingConfig& config) {
  constexpr double kFirstS = 0.5 * kSpeedLastsS;
  SpeedsSeen first = with_speed({}, {held.speed_mps, held.sigma_mps, kFirstS}, config);
  first.surely_mps = 0.0;  // it has yet to be held
  return first;
}

SpeedsSeen with_speed(const SpeedsSeen& before, const SpeedHeld& held,
                      const TrackingConfig& config) {
  const double speed_mps = held.speed_mps / config.extent.size_scale;
  const double sigma_mps = held.sigma_mps / config.extent.size_scale;
  const double fade = std::exp(-held.time_s / kSpeedMemoryS);
  SpeedsSeen after;
  // A moment's error is no speed: it must be held.
  const double gained_mps = std::max(0.0, speed_mps - 2.0 * sigma_mps - before.surely_mps);
  after.surely_mps =
      before.surely_mps + (1.0 - std::exp(-held.time_s / kSpeedProvenS)) * gained_mps;
  for (std::size_t i = 0; i < kSpeedRanges.size(); ++i) {
    const double density = normal_density(speed_mps - kSpeedRanges[i].speed_mps,
                                          std::hypot(kSpeedRanges[i].sigma_mps, sigma_mps));
    const double with_outliers = (1.0 - kOutlierShare) * density + kOutlierShare * kOutlierDensity;
    after.log_likelihood[i] =
        fade * before.log_likelihood[i] + held.time_s / kSpeedLastsS * std::log(with_outliers);
  }
  return after;
}

ClassProbabilities class_probabilities(const Outline& outline, const SpeedsSeen& speeds,
                                       const TrackingConfig& config) {
  constexpr double kLeast = 1e-6;
  ClassProbabilities log_weight = is_box(outline)
                                      ? log_fit_of_box(std::get<Box>(outline), config)
                                      : log_fit_of_blob(std::get<Blob>(outline), config);
  double most = -1e300;
  for (std::size_t i = 0; i < log_weight.size(); ++i) {
    log_weight[i] += speeds.log_likelihood[i] +
                     std::log(kLeast + exceeded_share(speeds.surely_mps, kSpeedRanges[i].top_mps,
                                                      kSpeedRanges[i].top_sigma_mps));
    if (only_people_move(config) && i >= kFirstVehicle) log_weight[i] += std::log(kShareIndoors);
    most = std::max(most, log_weight[i]);
  }
  ClassProbabilities probability;
  double total = 0.0;
  for (std::size_t i = 0; i < probability.size(); ++i)
    total += probability[i] = std::exp(log_weight[i] - most);
  for (double& one : probability) one /= total;
  return probability;
}

flow::ObjectClass likeliest_class(const ClassProbabilities& probability) {
  const auto best = std::max_element(probability.begin(), probability.end());
  if (*best <= 0.5) return flow::ObjectClass::kUnknown;
  return flow::class_of(static_cast<std::size_t>(best - probability.begin()));
}

}  // namespace slammot::tracking
