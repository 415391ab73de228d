#pragma once

#include <string>
#include <vector>

#include "services/evaluator/drawing.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {

/// Several plots below each other, with their captions and legends, for a file of its own.
Drawing draw_plots(const std::vector<CaptionedPlot>& plots);

/// Median, 99th percentile and maximum of each row on a logarithmic axis.
Drawing draw_log_bars(const std::vector<LogBar>& bars, const std::string& unit);

}  // namespace slammot::evaluator
