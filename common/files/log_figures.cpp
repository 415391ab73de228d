#include "common/files/log_figures.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "common/files/scan_clock.hpp"
#include "common/geometry/order_statistics.hpp"

namespace slammot::files {
namespace {

void add_figures_of_beams(const ScannerSurvey& scanner, const LogPlan& plan,
                          double fallback_field_of_view_rad, LogFigures& figures) {
  figures.beams = std::ranges::max_element(scanner.scans_by_beams, {}, [](const auto& beams) {
                    return beams.second;
                  })->first;
  const BeamLayout layout =
      scanner.layout.value_or(layout_by_convention(figures.beams, fallback_field_of_view_rad));
  figures.field_of_view_rad =
      std::min(std::abs(plan.evidence.correction.field_factor * layout.beam_step_rad) *
                   static_cast<double>(figures.beams),
               2.0 * std::numbers::pi);
  figures.max_range_m = plan.max_range_m;
  figures.median_range_m = scanner.readings.range_quantile_m(plan.max_range_m, 0.5);
  figures.far_range_m = scanner.readings.range_quantile_m(plan.max_range_m, 0.9);
  figures.scans_without_readings = scanner.readings.scans_without_readings();
  figures.are_of_scans = scanner.scans > 0;
  figures.echo_share = scanner.readings.echo_share(plan.max_range_m);
}

/// stamps_ns: in place of those of the marks; empty: those of the marks.
void add_figures_of_steps(std::span<const sensing::ScanMark> marks,
                          const std::vector<std::int64_t>& stamps_ns, LogFigures& figures) {
  const auto stamp_ns = [&](std::size_t i) {
    return stamps_ns.empty() ? marks[i].stamp_ns : std::optional(stamps_ns[i]);
  };
  std::vector<double> periods_s;
  std::vector<double> speeds_mps;
  for (std::size_t i = 1; i < marks.size(); ++i) {
    figures.distance_m += marks[i].way_m;
    if (!stamp_ns(i - 1) || !stamp_ns(i) || *stamp_ns(i) <= *stamp_ns(i - 1)) continue;
    periods_s.push_back(static_cast<double>(*stamp_ns(i) - *stamp_ns(i - 1)) * 1e-9);
    speeds_mps.push_back(marks[i].way_m / periods_s.back());
  }
  figures.scan_period_s = geometry::lower_quantile(periods_s, 0.5);
  figures.longest_gap_s = geometry::lower_quantile(periods_s, 1.0);
  if (figures.scan_period_s > 0.0)
    figures.scan_period_spread =
        (geometry::lower_quantile(periods_s, 0.9) - geometry::lower_quantile(periods_s, 0.1)) /
        figures.scan_period_s;
  figures.duration_s = std::accumulate(periods_s.begin(), periods_s.end(), 0.0);
  if (figures.has_clock) figures.cruising_speed_mps = geometry::lower_quantile(speeds_mps, 0.9);
}

}  // namespace

LogFigures log_figures_of(const ScannerSurvey& scanner, const LogPlan& plan,
                          double fallback_field_of_view_rad) {
  LogFigures figures;
  figures.scans = scanner.scans;
  figures.has_clock = plan.clock != LogClock::kNominal;
  if (scanner.scans == 0) return figures;
  add_figures_of_beams(scanner, plan, fallback_field_of_view_rad, figures);
  const std::vector<sensing::ScanMark> marks = scan_marks_of(scanner, plan, plan.clock);
  figures.comes_by_time = !figures.has_clock && sensing::comes_by_time(marks);
  add_figures_of_steps(marks, plan.times.stamps_ns, figures);
  return figures;
}

}  // namespace slammot::files
