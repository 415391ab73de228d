#pragma once

namespace slammot::metrics {

/// Share of a chi-square distribution below the value; degrees of freedom > 0. The regularized lower incomplete gamma
/// function by its series or its continued fraction, whichever converges: Press et al. 2007, section 6.2.
double chi_square_cdf(double value, double degrees_of_freedom);

/// The value that the share, in (0, 1), lies below.
double chi_square_quantile(double share, double degrees_of_freedom);

}  // namespace slammot::metrics
