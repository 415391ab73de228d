#include "common/metrics/chi_square.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace slammot::metrics {
namespace {

constexpr int kMaxTerms = 100000;  // a few times the square root of the degrees of freedom is
                                   // enough
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double common_factor(double shape, double x) {
  return std::exp(-x + shape * std::log(x) - std::lgamma(shape));
}

/// Press et al. 2007, Eq. (6.2.5).
double lower_by_series(double shape, double x) {
  double term = 1.0 / shape;
  double sum = term;
  for (int n = 1; n < kMaxTerms && std::abs(term) > std::abs(sum) * kEpsilon; ++n) {
    term *= x / (shape + n);
    sum += term;
  }
  return sum * common_factor(shape, x);
}

/// Press et al. 2007, Eq. (6.2.7), by Lentz's method.
double upper_by_continued_fraction(double shape, double x) {
  constexpr double kTiny = std::numeric_limits<double>::min() / kEpsilon;
  double b = x + 1.0 - shape;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double a = -n * (n - shape);
    b += 2.0;
    d = a * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + a / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    const double change = d * c;
    fraction *= change;
    if (std::abs(change - 1.0) <= kEpsilon) break;
  }
  return fraction * common_factor(shape, x);
}

}  // namespace

double chi_square_cdf(double value, double degrees_of_freedom) {
  assert(degrees_of_freedom > 0.0);
  if (value <= 0.0) return 0.0;
  const double shape = 0.5 * degrees_of_freedom;
  const double x = 0.5 * value;
  return x < shape + 1.0 ? lower_by_series(shape, x) : 1.0 - upper_by_continued_fraction(shape, x);
}

double chi_square_quantile(double share, double degrees_of_freedom) {
  assert(share > 0.0 && share < 1.0);
  double low = 0.0;
  double high = degrees_of_freedom + 1.0;
  while (chi_square_cdf(high, degrees_of_freedom) < share) high *= 2.0;
  for (int halving = 0; halving < 200 && high - low > high * kEpsilon; ++halving) {
    const double middle = 0.5 * (low + high);
    (chi_square_cdf(middle, degrees_of_freedom) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace slammot::metrics
