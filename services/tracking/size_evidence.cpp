#include "services/tracking/size_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/squared.hpp"

namespace slammot::tracking {
namespace {

using geometry::squared;

/// Product of the prior and the measurement from edge to edge, without the lower bound.
Size size_from_whole(double mean_m, double sigma_m, const SizeEvidence& evidence) {
  const double information = 1.0 / squared(sigma_m) + 1.0 / evidence.whole.variance_m2;
  return {(mean_m / squared(sigma_m) + evidence.whole.value_m / evidence.whole.variance_m2) /
              information,
          1.0 / information};
}

Size likely_size(double mean_m, double sigma_m, const SizeEvidence& evidence) {
  const Size size = size_from_whole(mean_m, sigma_m, evidence);
  return {std::max(size.value_m, evidence.least_m), size.variance_m2};
}

double log_likelihood_of_least(const Size& size, double least_m, double scale) {
  constexpr double kLeastSigmaM = 0.2;
  const double beyond_m = std::max(0.0, least_m - size.value_m);
  return -0.5 * squared(beyond_m) / (size.variance_m2 + squared(kLeastSigmaM * scale));
}

}  // namespace

void add_part(SizeEvidence& evidence, double seen_m) {
  constexpr double kGain = 0.3;
  if (seen_m > evidence.least_m)
    evidence.least_m += evidence.least_m == 0.0 ? seen_m : kGain * (seen_m - evidence.least_m);
}

void add_whole(SizeEvidence& evidence, const WholeSize& seen, double scale) {
  constexpr double kWholeSigmaM = 0.06;  // errors of one size measured again and again do not
                                         // average below this
  constexpr double kShorterM = 0.5;    // less than the lower bound by this much: a piece, or a side
                                       // seen askew
  constexpr double kForgotten = 0.02;  // of the lower bound a scan: it may be of several objects
  constexpr double kSharedShare = 0.25;  // of the variance: errors of neighbouring scans are
                                         // correlated
  const bool is_shorter = seen.size_m < evidence.least_m - kShorterM * scale;
  evidence.least_m =
      std::min(evidence.least_m, evidence.least_m + kForgotten * (seen.size_m - evidence.least_m));
  if (is_shorter) return;
  const double least_variance_m2 =
      std::max(squared(kWholeSigmaM * scale), kSharedShare * seen.variance_m2);
  if (evidence.whole.variance_m2 <= kSharedShare * seen.variance_m2) return;
  const double gain = evidence.whole.variance_m2 / (evidence.whole.variance_m2 + seen.variance_m2);
  evidence.whole.value_m += gain * (seen.size_m - evidence.whole.value_m);
  evidence.missed_share += gain * (seen.missed_share - evidence.missed_share);
  evidence.whole.variance_m2 =
      std::max(least_variance_m2, (1.0 - gain) * evidence.whole.variance_m2);
}

Size missed_of(const Size& corner, double share) {
  constexpr double kShapeShare = 0.2;
  return {share * corner.value_m, squared(share) * corner.variance_m2 +
                                      squared(std::min(share, kShapeShare) * corner.value_m)};
}

SizeEvidence with_corners(SizeEvidence evidence, const Size& corner) {
  const Size missed = missed_of(corner, evidence.missed_share);
  evidence.whole.value_m += missed.value_m;
  evidence.whole.variance_m2 += missed.variance_m2;
  return evidence;
}

double log_sum(double a, double b) {
  return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

double log_likelihood_of_size(double mean_m, double sigma_m, const SizeEvidence& evidence,
                              double scale) {
  const double variance_m2 = squared(sigma_m) + evidence.whole.variance_m2;
  return -0.5 * squared(evidence.whole.value_m - mean_m) / variance_m2 -
         0.5 * std::log(variance_m2) +
         std::min(log_likelihood_of_least({mean_m, squared(sigma_m)}, evidence.least_m, scale),
                  log_likelihood_of_least(size_from_whole(mean_m, sigma_m, evidence),
                                          evidence.least_m, scale));
}

SizeFit size_fit(double mean_m, double sigma_m, const SizeEvidence& evidence, double scale,
                 double log_piece_density) {
  constexpr double kPieceShare = 0.05;
  const double as_whole = log_likelihood_of_size(mean_m, sigma_m, evidence, scale);
  const Size whole = likely_size(mean_m, sigma_m, evidence);
  if (evidence.whole.variance_m2 >= kUnknownSizeM2) return {as_whole, whole};
  const Size piece = likely_size(mean_m, sigma_m, {evidence.least_m, {0.0, kUnknownSizeM2}});
  const double as_piece = log_piece_density + log_likelihood_of_least({mean_m, squared(sigma_m)},
                                                                      evidence.least_m, scale);
  const double of_whole = std::log(1.0 - kPieceShare) + as_whole;
  const double of_piece = std::log(kPieceShare) + as_piece;
  const double piece_share = 1.0 / (1.0 + std::exp(of_whole - of_piece));
  const bool is_piece = piece_share > 0.5;
  Size size = is_piece ? piece : whole;
  size.variance_m2 =
      piece_share * piece.variance_m2 + (1.0 - piece_share) * whole.variance_m2 +
      std::min(piece_share, 1.0 - piece_share) * squared(piece.value_m - whole.value_m);
  return {log_sum(of_whole, of_piece), size};
}

}  // namespace slammot::tracking
