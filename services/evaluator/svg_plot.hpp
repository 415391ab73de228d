#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::evaluator {

struct PlotPoint {
  double x = 0.0;
  double y = 0.0;
};

struct Series {
  std::string name;
  std::string colour;             ///< CSS colour.
  std::vector<PlotPoint> points;  ///< Ascending x.
  double longest_gap = 0.0;       ///< In x; longer gaps interrupt the line; 0: never.
  bool is_dashed = false;
};

/// A shaded interval of the x axis.
struct Span {
  double from = 0.0;
  double to = 0.0;
};

struct Plot {
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::vector<Span> shaded;
  std::optional<double> y_max;  ///< Upper limit of the y axis; default: from the series. Its lower
                                ///< limit is 0 or below.
  double height = 220.0;        ///< The width is 760.
};

struct CaptionedPlot {
  std::string caption;
  Plot plot;
};

struct Bar {
  std::string name;
  double value = 0.0;  ///< [0, 1]
  std::string remark;  ///< Text after the bar.
};

struct LogBar {
  std::string name;
  double low = 0.0;  ///< Positive, ascending.
  double middle = 0.0;
  double high = 0.0;
};

/// Curves over a common x axis; with a legend for several series. Long series are reduced to the
/// extremes of each pixel.
std::string to_svg(const Plot& plot);

/// Horizontal bars of shares.
std::string share_bars_svg(const std::vector<Bar>& bars, std::string_view colour);

/// Three marks per row on a logarithmic axis.
std::string log_bars_svg(const std::vector<LogBar>& bars, std::string_view unit);

/// Text with HTML and SVG special characters escaped.
std::string escaped(std::string_view text);

/// A number with as few characters as SVG needs.
std::string svg_number(double value);

/// Of an element, with the space before it.
std::string attribute(const char* name, double value);

}  // namespace slammot::evaluator
