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
  std::string colour;             ///< As CSS writes it.
  std::vector<PlotPoint> points;  ///< Ascending x.
  double longest_gap = 0.0;       ///< Of x: the line breaks where it is longer; 0 for never.
  bool is_dashed = false;
};

/// A part of the x axis that is shaded.
struct Span {
  double from = 0.0;
  double to = 0.0;
};

struct Plot {
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  std::vector<Span> shaded;
  std::optional<double> y_max;  ///< Else what the series need; y begins at 0 or below.
  double height = 220.0;        ///< Of 760 units of width.
};

struct Bar {
  std::string name;
  double value = 0.0;  ///< [0, 1]
  std::string remark;  ///< Behind the bar.
};

struct LogBar {
  std::string name;
  double low = 0.0;  ///< Positive, ascending.
  double middle = 0.0;
  double high = 0.0;
};

/// Curves over one x axis, with a legend where there are several. Long series are thinned to the
/// extremes of each pixel.
std::string to_svg(const Plot& plot);

/// Horizontal bars of shares.
std::string share_bars_svg(const std::vector<Bar>& bars, std::string_view colour);

/// Three marks a row on a logarithmic axis.
std::string log_bars_svg(const std::vector<LogBar>& bars, std::string_view unit);

/// Text that HTML and SVG show as it is.
std::string escaped(std::string_view text);

/// A number as short as SVG needs it.
std::string svg_number(double value);

}  // namespace slammot::evaluator
