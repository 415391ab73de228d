#include "services/evaluator/plot_drawing.hpp"

#include <charconv>
#include <cmath>

#include "services/evaluator/plot_axes.hpp"

namespace slammot::evaluator {
namespace {

constexpr files::Rgb kGrid = {230, 233, 237};
constexpr files::Rgb kFrame = {140, 149, 159};
constexpr files::Rgb kText = {70, 78, 87};
constexpr double kSize = 12.0;
constexpr double kCaption = 26.0;  // height
constexpr double kLegend = 22.0;

/// "#rrggbb" or "#rgb"; black for anything else.
files::Rgb colour_in(const std::string& css) {
  std::string digits = css.starts_with("#") ? css.substr(1) : "";
  if (digits.size() == 3)
    digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  unsigned value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return {static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255U),
          static_cast<std::uint8_t>(value & 255U)};
}

void add_line(Drawing& drawing, PlotPoint from, PlotPoint to, const files::Rgb& colour,
              double width = 1.0) {
  drawing.marks.emplace_back(LineMark{{from, to}, {colour}, width});
}

void add_text(Drawing& drawing, PlotPoint at, const std::string& text, Anchor anchor,
              bool is_upward = false) {
  drawing.marks.emplace_back(TextMark{at, text, {kText}, kSize, anchor, is_upward});
}

void add_axes(const Plot& plot, const Axis& x, const Axis& y, double top, Drawing& drawing) {
  const double right = kPlotWidth - kPlotRight;
  const double bottom = top + plot.height - kPlotBottom;
  for (const double value : ticks(y, 5)) {
    add_line(drawing, {kPlotLeft, top + y(value)}, {right, top + y(value)},
             value == 0.0 ? kFrame : kGrid);
    add_text(drawing, {kPlotLeft - 6.0, top + y(value) + 4.0}, svg_number(value), Anchor::kEnd);
  }
  for (const double value : ticks(x, 8)) {
    add_line(drawing, {x(value), bottom}, {x(value), bottom + 4.0}, kFrame);
    add_text(drawing, {x(value), bottom + 16.0}, svg_number(value), Anchor::kMiddle);
  }
  add_text(drawing, {0.5 * (kPlotLeft + right), top + plot.height - 6.0}, plot.x_label,
           Anchor::kMiddle);
  add_text(drawing, {14.0, top + 0.5 * (kPlotTop + plot.height - kPlotBottom)}, plot.y_label,
           Anchor::kMiddle, true);
}

void add_legend(const std::vector<Series>& series, double top, Drawing& drawing) {
  double left = kPlotLeft;
  for (const Series& one : series) {
    drawing.marks.emplace_back(LineMark{{{left, top + 8.0}, {left + 24.0, top + 8.0}},
                                        {colour_in(one.colour)},
                                        2.5,
                                        one.is_dashed});
    add_text(drawing, {left + 30.0, top + 12.0}, one.name, Anchor::kStart);
    left += 60.0 + 6.5 * static_cast<double>(one.name.size());
  }
}

double height_of(const CaptionedPlot& one) {
  return kCaption + one.plot.height + (one.plot.series.size() > 1 ? kLegend : 0.0);
}

void add_plot(const CaptionedPlot& one, double top, Drawing& drawing) {
  const Axis x = x_axis(one.plot);
  const Axis y = y_axis(one.plot);
  drawing.marks.emplace_back(
      TextMark{{kPlotLeft, top + 18.0}, one.caption, {kText}, 13.5, Anchor::kStart});
  top += kCaption;
  for (const Span& span : one.plot.shaded) {
    const double left = x(std::max(span.from, x.low));
    const double right = std::max(left + 1.0, x(std::min(span.to, x.high)));
    const double bottom = top + one.plot.height - kPlotBottom;
    drawing.marks.emplace_back(
        AreaMark{{{left, top + kPlotTop}, {right, top + kPlotTop}, {right, bottom}, {left, bottom}},
                 {{244, 214, 204}}});
  }
  add_axes(one.plot, x, y, top, drawing);
  for (const Series& series : one.plot.series) {
    for (std::vector<PlotPoint>& line : lines_of(series, x, y)) {
      for (PlotPoint& point : line) point.y += top;
      drawing.marks.emplace_back(
          LineMark{std::move(line), {colour_in(series.colour)}, 1.5, series.is_dashed});
    }
  }
  if (one.plot.series.size() > 1) add_legend(one.plot.series, top + one.plot.height, drawing);
}

}  // namespace

Drawing draw_plots(const std::vector<CaptionedPlot>& plots) {
  Drawing drawing{kPlotWidth, 10.0, {255, 255, 255}, {}};
  for (const CaptionedPlot& one : plots) {
    add_plot(one, drawing.height - 10.0, drawing);
    drawing.height += height_of(one);
  }
  return drawing;
}

Drawing draw_log_bars(const std::vector<LogBar>& bars, const std::string& unit) {
  constexpr double kRow = 26.0;
  constexpr double kNames = 120.0;
  constexpr files::Rgb kRange = {184, 192, 200};
  const Axis x = log_axis(bars, kNames, kPlotWidth - 40.0);
  const double bottom = kRow * static_cast<double>(bars.size()) + 12.0;
  Drawing drawing{kPlotWidth, bottom + 62.0, {255, 255, 255}, {}};
  if (!std::isfinite(x.low)) return drawing;
  for (double power = x.low; power <= x.high + 1e-9; power += 1.0) {
    add_line(drawing, {x(power), 6.0}, {x(power), bottom}, kGrid);
    add_text(drawing, {x(power), bottom + 16.0}, svg_number(std::pow(10.0, power)),
             Anchor::kMiddle);
  }
  const auto place = [&](double value) { return x(value > 0.0 ? std::log10(value) : x.low); };
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const double middle = 8.0 + kRow * (static_cast<double>(i) + 0.5);
    add_text(drawing, {kNames - 8.0, middle + 4.0}, bars[i].name, Anchor::kEnd);
    add_line(drawing, {place(bars[i].low), middle}, {place(bars[i].high), middle}, kRange, 3.0);
    for (const auto& [value, colour] : {std::pair(bars[i].low, files::Rgb{31, 95, 168}),
                                        std::pair(bars[i].middle, files::Rgb{224, 161, 0}),
                                        std::pair(bars[i].high, files::Rgb{217, 72, 15})})
      drawing.marks.emplace_back(LineMark{{{place(value), middle}}, {colour}, 10.0});
  }
  add_text(drawing, {0.5 * (kNames + kPlotWidth), bottom + 34.0}, unit, Anchor::kMiddle);
  add_legend(
      {{"median", "#1f5fa8", {}}, {"99th percentile", "#e0a100", {}}, {"maximum", "#d9480f", {}}},
      bottom + 38.0, drawing);
  return drawing;
}

}  // namespace slammot::evaluator
