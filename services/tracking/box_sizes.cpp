#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "common/geometry/squared.hpp"
#include "services/tracking/box.hpp"

namespace slammot::tracking {
namespace {

using geometry::squared;

/// Posterior sizes under one kind of road user, and the log-likelihood of the evidence.
struct KindFit {
  double log_fit = 0.0;
  SizeFit length;
  SizeFit width;
};

using KindFits = std::array<KindFit, std::tuple_size_v<decltype(RoadUsers::kinds)>>;

KindFits kind_fits(const Box& box, const TrackingConfig& config) {
  constexpr double kLongestPieceM = 16.0;
  const double scale = config.extent.size_scale;
  // log_likelihood_of_size() omits the root.
  const double log_piece_density =
      std::log(std::sqrt(2.0 * std::numbers::pi) / (kLongestPieceM * scale));
  const EvidenceByKind evidence = evidence_by_kind(box, config);
  const auto fit_of = [&](const KindOfBody& kind) {
    KindFit fit;
    if (kind.share <= 0.0) return KindFit{-std::numeric_limits<double>::max(), {}, {}};
    fit.length = size_fit(scale * kind.length_m, scale * kind.length_sigma_m,
                          evidence.of(kind.kind).length, scale, log_piece_density);
    fit.width = size_fit(scale * kind.width_m, scale * kind.width_sigma_m,
                         evidence.of(kind.kind).width, scale, log_piece_density);
    fit.log_fit = kind.log_share + fit.length.log_fit + fit.width.log_fit;
    return fit;
  };
  KindFits fits;
  std::ranges::transform(box.road_users->kinds, fits.begin(), fit_of);
  return fits;
}

SizesSeen with_corners(const Box& box, const Size& corner) {
  return {with_corners(box.evidence.length, corner), with_corners(box.evidence.width, corner)};
}

}  // namespace

Size corner_of(const Box& box, Kind kind, const TrackingConfig& config) {
  if (kind == Kind::kBicycle || only_people_move(config)) return {0.0, 0.0};
  const double prior_m2 = squared(config.extent.size_scale) * box.road_users->corner.variance_m2;
  const double gain = prior_m2 / (prior_m2 + box.corner_seen.variance_m2);
  const double prior_m = config.extent.size_scale * box.road_users->corner.value_m;
  return {prior_m + gain * (box.corner_seen.value_m - prior_m), (1.0 - gain) * prior_m2};
}

EvidenceByKind evidence_by_kind(const Box& box, const TrackingConfig& config) {
  return {with_corners(box, corner_of(box, Kind::kBicycle, config)),
          with_corners(box, corner_of(box, Kind::kCar, config))};
}

Box with_likely_sizes(Box box, const TrackingConfig& config) {
  const KindFits fits = kind_fits(box, config);
  const auto best = std::ranges::max_element(fits, {}, &KindFit::log_fit);
  box.kind = box.road_users->kinds[static_cast<std::size_t>(best - fits.begin())].kind;
  box.length = {best->length.size.value_m, 0.0};
  box.width = {best->width.size.value_m, 0.0};
  double total = 0.0;
  for (const KindFit& fit : fits) {  // second moments about the likeliest kind's sizes
    const double weight = std::exp(fit.log_fit - best->log_fit);
    total += weight;
    box.length.variance_m2 += weight * (fit.length.size.variance_m2 +
                                        squared(fit.length.size.value_m - box.length.value_m));
    box.width.variance_m2 +=
        weight * (fit.width.size.variance_m2 + squared(fit.width.size.value_m - box.width.value_m));
  }
  box.length.variance_m2 /= total;
  box.width.variance_m2 /= total;
  box.length.value_m = std::min(box.length.value_m, config.extent.longest_body_m);
  box.width.value_m = std::min(box.width.value_m, kWidestM * config.extent.size_scale);
  return box;
}

double log_evidence_of_sizes(const Box& box, const TrackingConfig& config) {
  double sum = -std::numeric_limits<double>::max();
  for (const KindFit& fit : kind_fits(box, config)) sum = log_sum(sum, fit.log_fit);
  return sum;
}

}  // namespace slammot::tracking
