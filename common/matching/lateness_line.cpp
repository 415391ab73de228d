#include "common/matching/lateness_line.hpp"

#include <cmath>

namespace slammot::matching {
namespace {

using ErrorOf = std::function<double(double late_s, double change_s)>;

constexpr double kLineReach_s = 0.16;   // of the lateness in the middle
constexpr double kCoarseStep_s = 0.02;  // errors of pairs are limited: the valley is this wide
constexpr double kFinestStep_s = 0.001;
constexpr double kBend_s = 0.02;  // over which the curve of errors is taken for a parabola

/// Best of a grid of so many steps to either side.
LatenessLine best_around(const ErrorOf& error_of, const LatenessLine& middle, int lates,
                         int changes, double step_s) {
  LatenessLine best = middle;
  for (int late = -lates; late <= lates; ++late) {
    for (int change = -changes; change <= changes; ++change) {
      const double late_s = middle.late_s + late * step_s;
      const double change_s = middle.change_s + 2.0 * change * step_s;
      const double error = error_of(late_s, change_s);
      if (error < best.error) best = {late_s, change_s, error, 0.0, 0.0};
    }
  }
  return best;
}

/// One sigma of the change, whatever the lateness in the middle is; nullopt without a bend.
std::optional<double> sigma_of_change_s(const ErrorOf& error_of, const LatenessLine& best) {
  const auto error_at = [&](int late, int change) {
    return error_of(best.late_s + late * kBend_s, best.change_s + 2.0 * change * kBend_s);
  };
  const double by_late = error_at(-1, 0) - 2.0 * best.error + error_at(1, 0);
  const double by_change = error_at(0, -1) - 2.0 * best.error + error_at(0, 1);
  const double by_both =
      0.25 * (error_at(1, 1) - error_at(1, -1) - error_at(-1, 1) + error_at(-1, -1));
  const double bend = by_change - by_both * by_both / by_late;
  if (!(by_late > 0.0) || !(bend > 0.0)) return std::nullopt;
  return 2.0 * kBend_s * std::sqrt(2.0 / bend);
}

/// From coarse to fine; finer steps only along the lateness where the change is fixed.
LatenessLine refined(const ErrorOf& error_of, LatenessLine best, int changes) {
  for (double step_s = 0.5 * kCoarseStep_s; step_s > kFinestStep_s; step_s *= 0.5)
    best = best_around(error_of, best, 2, changes, step_s);
  return best;
}

}  // namespace

std::optional<LatenessLine> best_lateness_line(const ErrorOf& error_of, double around_s,
                                               double most_change_s) {
  const int lates = static_cast<int>(kLineReach_s / kCoarseStep_s);
  const int changes = static_cast<int>(0.5 * most_change_s / kCoarseStep_s);
  const LatenessLine start{around_s, 0.0, error_of(around_s, 0.0), 0.0, 0.0};
  const LatenessLine coarse = best_around(error_of, start, lates, changes, kCoarseStep_s);
  const bool is_inside = std::abs(coarse.late_s - around_s) < kLineReach_s - 0.5 * kCoarseStep_s &&
                         std::abs(coarse.change_s) < 2.0 * kCoarseStep_s * (changes - 0.5);
  if (!is_inside) return std::nullopt;
  LatenessLine best = refined(error_of, coarse, 2);
  const auto sigma_s = sigma_of_change_s(error_of, best);
  if (!sigma_s) return std::nullopt;
  best.sigma_change_s = *sigma_s;
  best.error_without_change =
      refined(error_of, best_around(error_of, start, lates, 0, kCoarseStep_s), 0).error;
  return best;
}

}  // namespace slammot::matching
