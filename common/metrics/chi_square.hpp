#pragma once

namespace slammot::metrics {

/// Cumulative chi-square distribution; degrees of freedom > 0. Regularized lower incomplete gamma
/// function by its series or its continued fraction, whichever converges: Press et al. 2007,
/// section 6.2.
double chi_square_cdf(double value, double degrees_of_freedom);

/// Quantile of chi-square at this share, in (0, 1).
double chi_square_quantile(double share, double degrees_of_freedom);

}  // namespace slammot::metrics
