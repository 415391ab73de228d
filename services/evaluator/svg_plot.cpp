#include "services/evaluator/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace slammot::evaluator {
namespace {

constexpr double kWidth = 760.0;
constexpr double kLeft = 58.0;
constexpr double kRight = 12.0;
constexpr double kTop = 10.0;
constexpr double kBottom = 38.0;

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + svg_number(value) + "\"";
}

std::string text_at(double x, double y, const char* anchor, std::string_view text,
                    const std::string& extra = "") {
  return "<text" + attribute("x", x) + attribute("y", y) + " text-anchor=\"" + anchor + "\"" +
         extra + ">" + escaped(text) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const char* kind) {
  return std::string("<line class=\"") + kind + "\"" + attribute("x1", x1) + attribute("y1", y1) +
         attribute("x2", x2) + attribute("y2", y2) + "/>";
}

std::string begin_svg(double height) {
  return "<svg viewBox=\"0 0 " + svg_number(kWidth) + " " + svg_number(height) + "\" role=\"img\">";
}

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

struct Axis {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;  // position in the image
  double to = 1.0;

  double operator()(double value) const {
    return from + (value - low) / (high - low) * (to - from);
  }
};

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Axis x_axis(const Plot& plot) {
  Extent extent;
  for (const Series& series : plot.series) {
    for (const PlotPoint& point : series.points) extent.include(point.x);
  }
  if (!(extent.high > extent.low))
    extent = {std::isfinite(extent.low) ? extent.low - 0.5 : 0.0,
              std::isfinite(extent.low) ? extent.low + 0.5 : 1.0};
  return {extent.low, extent.high, kLeft, kWidth - kRight};
}

Axis y_axis(const Plot& plot) {
  Extent extent{0.0, 0.0};
  for (const Series& series : plot.series) {
    for (const PlotPoint& point : series.points) extent.include(point.y);
  }
  if (plot.y_max) extent.high = *plot.y_max;
  if (!(extent.high > extent.low)) extent.high = extent.low + 1.0;
  return {extent.low, extent.low + (extent.high - extent.low) * (plot.y_max ? 1.0 : 1.06),
          plot.height - kBottom, kTop};
}

std::string grid(const Plot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  const double y_step = round_step(y.high - y.low, 5);
  for (double value = std::ceil(y.low / y_step) * y_step; value <= y.high + 1e-9 * y_step;
       value += y_step) {
    svg += line(kLeft, y(value), kWidth - kRight, y(value),
                std::abs(value) < 1e-9 * y_step ? "axis" : "grid");
    svg += text_at(kLeft - 6.0, y(value) + 4.0, "end",
                   svg_number(std::round(value / y_step) * y_step));
  }
  const double x_step = round_step(x.high - x.low, 8);
  for (double value = std::ceil(x.low / x_step) * x_step; value <= x.high + 1e-9 * x_step;
       value += x_step) {
    svg += line(x(value), plot.height - kBottom, x(value), plot.height - kBottom + 4.0, "axis");
    svg += text_at(x(value), plot.height - kBottom + 16.0, "middle",
                   svg_number(std::round(value / x_step) * x_step));
  }
  svg += text_at(0.5 * (kLeft + kWidth - kRight), plot.height - 4.0, "middle", plot.x_label);
  const double middle = 0.5 * (kTop + plot.height - kBottom);
  const std::string turn = " transform=\"rotate(-90 14 " + svg_number(middle) + ")\"";
  return svg + text_at(14.0, middle, "middle", plot.y_label, turn);
}

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

std::string curve(const Series& series, const Axis& x, const Axis& y) {
  std::string path;
  const std::vector<PlotPoint> points = thinned(series.points, x);
  // Thinning leaves gaps of up to a pixel, which must not interrupt the line.
  const double longest_gap = std::max(series.longest_gap, 3.0 * (x.high - x.low) / (x.to - x.from));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool begins =
        i == 0 || (series.longest_gap > 0.0 && points[i].x - points[i - 1].x > longest_gap);
    path.append(1, begins ? 'M' : 'L')
        .append(svg_number(x(points[i].x)))
        .append(1, ' ')
        .append(svg_number(y(std::clamp(points[i].y, y.low, y.high))));
  }
  if (path.empty()) return {};
  return "<path class=\"curve\" stroke=\"" + series.colour + "\"" +
         (series.is_dashed ? " stroke-dasharray=\"6 4\"" : "") + " d=\"" + path + "\"/>";
}

std::string legend(const std::vector<Series>& series) {
  std::string html = "<p class=\"legend\">";
  for (const Series& one : series) {
    html +=
        "<span><svg class=\"key\" viewBox=\"0 0 24 8\"><line x1=\"0\" y1=\"4\" x2=\"24\" y2=\"4\" "
        "stroke-width=\"2.5\" stroke=\"" +
        one.colour + "\"" + (one.is_dashed ? " stroke-dasharray=\"6 4\"" : "") + "/></svg>" +
        escaped(one.name) + "</span>";
  }
  return html + "</p>";
}

}  // namespace

std::string svg_number(double value) {
  std::array<char, 64> digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(),
                    std::round(value * 1e4) / 1e4 + 0.0, std::chars_format::general, 8);
  return {digits.data(), end.ptr};
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += letter;
    }
  }
  return result;
}

std::string to_svg(const Plot& plot) {
  const Axis x = x_axis(plot);
  const Axis y = y_axis(plot);
  std::string svg = begin_svg(plot.height);
  for (const Span& span : plot.shaded) {
    const double from = x(std::max(span.from, x.low));
    svg += "<rect class=\"shade\"" + attribute("x", from) + attribute("y", kTop) +
           attribute("width", std::max(1.0, x(std::min(span.to, x.high)) - from)) +
           attribute("height", plot.height - kBottom - kTop) + "/>";
  }
  svg += grid(plot, x, y);
  for (const Series& series : plot.series) svg += curve(series, x, y);
  return svg + "</svg>" + (plot.series.size() > 1 ? legend(plot.series) : "");
}

std::string share_bars_svg(const std::vector<Bar>& bars, std::string_view colour) {
  constexpr double kRow = 24.0;
  constexpr double kNames = 110.0;
  constexpr double kRemarks = 150.0;
  const double full = kWidth - kNames - kRemarks;
  std::string svg = begin_svg(kRow * static_cast<double>(bars.size()) + 4.0);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double top = 4.0 + kRow * static_cast<double>(i);
    svg += text_at(kNames - 8.0, top + 14.0, "end", bars[i].name);
    svg += "<rect class=\"trough\"" + attribute("x", kNames) + attribute("y", top) +
           attribute("width", full) + attribute("height", kRow - 6.0) + "/>";
    svg += "<rect fill=\"" + std::string(colour) + "\"" + attribute("x", kNames) +
           attribute("y", top) + attribute("width", full * std::clamp(bars[i].value, 0.0, 1.0)) +
           attribute("height", kRow - 6.0) + "/>";
    svg += text_at(kNames + full + 8.0, top + 14.0, "start", bars[i].remark);
  }
  return svg + "</svg>";
}

std::string log_bars_svg(const std::vector<LogBar>& bars, std::string_view unit) {
  constexpr double kRow = 26.0;
  constexpr double kNames = 110.0;
  Extent extent;
  for (const LogBar& bar : bars) {
    for (const double value : {bar.low, bar.high}) {
      if (value > 0.0) extent.include(std::log10(value));
    }
  }
  if (!std::isfinite(extent.low)) return {};
  const Axis x{std::floor(extent.low),
               std::max(std::ceil(extent.high), std::floor(extent.low) + 1.0), kNames,
               kWidth - 40.0};
  const auto place = [&](double value) { return x(value > 0.0 ? std::log10(value) : x.low); };
  const double bottom = kRow * static_cast<double>(bars.size()) + 6.0;
  std::string svg = begin_svg(bottom + 36.0);
  for (double power = x.low; power <= x.high + 1e-9; power += 1.0) {
    svg += line(x(power), 2.0, x(power), bottom, "grid") +
           text_at(x(power), bottom + 14.0, "middle", svg_number(std::pow(10.0, power)));
  }
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double middle = 4.0 + kRow * (static_cast<double>(i) + 0.5);
    svg += text_at(kNames - 8.0, middle + 4.0, "end", bars[i].name);
    svg += line(place(bars[i].low), middle, place(bars[i].high), middle, "range");
    svg += "<circle class=\"low\" r=\"5\"" + attribute("cx", place(bars[i].low)) +
           attribute("cy", middle) + "/>";
    svg += "<circle class=\"middle\" r=\"5\"" + attribute("cx", place(bars[i].middle)) +
           attribute("cy", middle) + "/>";
    svg += "<circle class=\"high\" r=\"4\"" + attribute("cx", place(bars[i].high)) +
           attribute("cy", middle) + "/>";
  }
  return svg + text_at(0.5 * (kNames + kWidth), bottom + 30.0, "middle", unit) + "</svg>";
}

}  // namespace slammot::evaluator
