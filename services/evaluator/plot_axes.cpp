#include "services/evaluator/plot_axes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slammot::evaluator {
namespace {

/// The smallest of 1, 2 or 5 times a power of ten that divides the range into at most about `steps`
/// steps.
double round_step(double range, int steps) {
  const double raw = range / steps;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Keeps the lowest and the highest point of each column of pixels, in their order.
std::vector<PlotPoint> thinned(const std::vector<PlotPoint>& points, const Axis& x) {
  std::vector<PlotPoint> kept;
  for (std::size_t begin = 0; begin < points.size();) {
    std::size_t end = begin;
    const double column = std::floor(x(points[begin].x));
    while (end < points.size() && std::floor(x(points[end].x)) == column) ++end;
    const auto [lowest, highest] =
        std::minmax_element(points.begin() + static_cast<std::ptrdiff_t>(begin),
                            points.begin() + static_cast<std::ptrdiff_t>(end),
                            [](const PlotPoint& a, const PlotPoint& b) { return a.y < b.y; });
    kept.push_back(*std::min(lowest, highest));
    if (lowest != highest) kept.push_back(*std::max(lowest, highest));
    begin = end;
  }
  return kept;
}

}  // namespace

Axis x_axis(const Plot& plot) {
  Extent extent;
  for (const Series& series : plot.series) {
    for (const PlotPoint& point : series.points) extent.include(point.x);
  }
  if (!(extent.high > extent.low))
    extent = {std::isfinite(extent.low) ? extent.low - 0.5 : 0.0,
              std::isfinite(extent.low) ? extent.low + 0.5 : 1.0};
  return {extent.low, extent.high, kPlotLeft, kPlotWidth - kPlotRight};
}

Axis y_axis(const Plot& plot) {
  Extent extent{0.0, 0.0};
  for (const Series& series : plot.series) {
    for (const PlotPoint& point : series.points) extent.include(point.y);
  }
  if (plot.y_max) extent.high = *plot.y_max;
  if (!(extent.high > extent.low)) extent.high = extent.low + 1.0;
  return {extent.low, extent.low + (extent.high - extent.low) * (plot.y_max ? 1.0 : 1.06),
          plot.height - kPlotBottom, kPlotTop};
}

Axis log_axis(const std::vector<LogBar>& bars, double from, double to) {
  Extent extent;
  for (const LogBar& bar : bars) {
    for (const double value : {bar.low, bar.high}) {
      if (value > 0.0) extent.include(std::log10(value));
    }
  }
  return {std::floor(extent.low), std::max(std::ceil(extent.high), std::floor(extent.low) + 1.0),
          from, to};
}

std::vector<double> ticks(const Axis& axis, int steps) {
  std::vector<double> values;
  const double step = round_step(axis.high - axis.low, steps);
  for (double value = std::ceil(axis.low / step) * step; value <= axis.high + 1e-9 * step;
       value += step)
    values.push_back(std::round(value / step) * step);
  return values;
}

std::vector<std::vector<PlotPoint>> lines_of(const Series& series, const Axis& x, const Axis& y) {
  std::vector<std::vector<PlotPoint>> lines;
  const std::vector<PlotPoint> points = thinned(series.points, x);
  // Thinning leaves gaps of up to a pixel, which must not interrupt the line.
  const double longest_gap = std::max(series.longest_gap, 3.0 * (x.high - x.low) / (x.to - x.from));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool begins =
        i == 0 || (series.longest_gap > 0.0 && points[i].x - points[i - 1].x > longest_gap);
    if (begins) lines.emplace_back();
    lines.back().push_back({x(points[i].x), y(std::clamp(points[i].y, y.low, y.high))});
  }
  return lines;
}

}  // namespace slammot::evaluator
