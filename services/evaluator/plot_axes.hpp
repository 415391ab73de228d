#pragma once

#include <vector>

#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {

/// Width of plots and their margins, in the unit of their pictures.
inline constexpr double kPlotWidth = 760.0;
inline constexpr double kPlotLeft = 58.0;
inline constexpr double kPlotRight = 12.0;
inline constexpr double kPlotTop = 10.0;
inline constexpr double kPlotBottom = 38.0;

/// From a value to its place along a side of the picture.
struct Axis {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;
  double to = 1.0;

  double operator()(double value) const {
    return from + (value - low) / (high - low) * (to - from);
  }
};

Axis x_axis(const Plot& plot);
Axis y_axis(const Plot& plot);

/// Axis of powers of ten for log_bars_svg(), of logarithms; `low` is infinite without positive
/// values.
Axis log_axis(const std::vector<LogBar>& bars, double from, double to);

/// Round values on an axis, about `steps` of them.
std::vector<double> ticks(const Axis& axis, int steps);

/// Lines of a series in the picture: thinned to the extremes of each pixel, limited to the axes,
/// and interrupted where the series has a gap.
std::vector<std::vector<PlotPoint>> lines_of(const Series& series, const Axis& x, const Axis& y);

}  // namespace slammot::evaluator
