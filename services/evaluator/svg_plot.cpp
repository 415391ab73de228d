#include "services/evaluator/svg_plot.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "services/evaluator/plot_axes.hpp"

namespace slammot::evaluator {
namespace {

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
  return "<svg viewBox=\"0 0 " + svg_number(kPlotWidth) + " " + svg_number(height) +
         "\" role=\"img\">";
}

std::string grid(const Plot& plot, const Axis& x, const Axis& y) {
  std::string svg;
  const double right = kPlotWidth - kPlotRight;
  const double bottom = plot.height - kPlotBottom;
  for (const double value : ticks(y, 5)) {
    svg += line(kPlotLeft, y(value), right, y(value), value == 0.0 ? "axis" : "grid");
    svg += text_at(kPlotLeft - 6.0, y(value) + 4.0, "end", svg_number(value));
  }
  for (const double value : ticks(x, 8)) {
    svg += line(x(value), bottom, x(value), bottom + 4.0, "axis");
    svg += text_at(x(value), bottom + 16.0, "middle", svg_number(value));
  }
  svg += text_at(0.5 * (kPlotLeft + right), plot.height - 4.0, "middle", plot.x_label);
  const double middle = 0.5 * (kPlotTop + bottom);
  const std::string turn = " transform=\"rotate(-90 14 " + svg_number(middle) + ")\"";
  return svg + text_at(14.0, middle, "middle", plot.y_label, turn);
}

std::string curve(const Series& series, const Axis& x, const Axis& y) {
  std::string path;
  for (const std::vector<PlotPoint>& points : lines_of(series, x, y)) {
    for (std::size_t i = 0; i < points.size(); ++i)
      path.append(1, i == 0 ? 'M' : 'L')
          .append(svg_number(points[i].x))
          .append(1, ' ')
          .append(svg_number(points[i].y));
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

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + svg_number(value) + "\"";
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
    svg += "<rect class=\"shade\"" + attribute("x", from) + attribute("y", kPlotTop) +
           attribute("width", std::max(1.0, x(std::min(span.to, x.high)) - from)) +
           attribute("height", plot.height - kPlotBottom - kPlotTop) + "/>";
  }
  svg += grid(plot, x, y);
  for (const Series& series : plot.series) svg += curve(series, x, y);
  return svg + "</svg>" + (plot.series.size() > 1 ? legend(plot.series) : "");
}

std::string share_bars_svg(const std::vector<Bar>& bars, std::string_view colour) {
  constexpr double kRow = 24.0;
  constexpr double kNames = 110.0;
  constexpr double kRemarks = 150.0;
  const double full = kPlotWidth - kNames - kRemarks;
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
  const Axis x = log_axis(bars, kNames, kPlotWidth - 40.0);
  if (!std::isfinite(x.low)) return {};
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
  return svg + text_at(0.5 * (kNames + kPlotWidth), bottom + 30.0, "middle", unit) + "</svg>";
}

}  // namespace slammot::evaluator
