#pragma once

#include "services/tracking/road_users.hpp"

namespace slammot::tracking {

/// Variance of a size that was never measured [m^2].
inline constexpr double kUnknownSizeM2 = 1e6;

/// What the scans so far say of one size of a box.
struct SizeEvidence {
  double least_m = 0.0;                ///< Lower bound: the largest part seen in one scan.
  Size whole = {0.0, kUnknownSizeM2};  ///< Measured from edge to edge.
  double missed_share = 0.0;           ///< Part of the corner depth that `whole` lacks.
};

/// Evidence of both sizes.
struct SizesSeen {
  SizeEvidence length;
  SizeEvidence width;
};

/// A size measured from edge to edge in one scan.
struct WholeSize {
  double size_m = 0.0;
  double variance_m2 = 1.0;
  double missed_share = 0.0;  ///< Part of the corner depth that the measurement lacks.
};

/// Raises the lower bound towards what one scan shows; a low gain keeps single outliers from
/// growing the box.
void add_part(SizeEvidence& evidence, double seen_m);

/// Fuses a measurement from edge to edge. scale: of all sizes, relative to real road users.
void add_whole(SizeEvidence& evidence, const WholeSize& seen, double scale);

/// What a corner of this depth hides from beams that miss this share of it. Cuts and arcs differ:
/// the variance covers both.
Size missed_of(const Size& corner, double share);

/// The evidence with the part that corners of this depth hide added to what was measured from edge
/// to edge.
SizeEvidence with_corners(SizeEvidence evidence, const Size& corner);

/// log(exp(a) + exp(b)).
double log_sum(double a, double b);

/// Log-likelihood of the evidence if sizes are normal with this mean and sigma. scale: as above.
double log_likelihood_of_size(double mean_m, double sigma_m, const SizeEvidence& evidence,
                              double scale);

/// Posterior of a size under one kind of road user, and the log-likelihood of its evidence.
struct SizeFit {
  double log_fit = 0.0;
  Size size;
};

/// Fits a normal prior to the evidence. The measurement from edge to edge may be of a piece between
/// two occluders: then only the prior tells the size, and its density is log_piece_density.
SizeFit size_fit(double mean_m, double sigma_m, const SizeEvidence& evidence, double scale,
                 double log_piece_density);

}  // namespace slammot::tracking
