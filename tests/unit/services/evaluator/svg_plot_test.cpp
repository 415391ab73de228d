#include "services/evaluator/svg_plot.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST(SvgNumber, IsShortAndHasNoMinusZero) {
  EXPECT_EQ(svg_number(1.50000001), "1.5");
  EXPECT_EQ(svg_number(-0.00000001), "0");
}

TEST(Escaped, EscapesSpecialCharactersOfHtml) {
  EXPECT_EQ(escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
}

TEST(Plot, BreaksALineAtAGap) {
  Plot plot{"t", "y", {{"one", "#000", {{0, 1}, {10, 1}, {50, 2}, {60, 1}}, 20.0}}, {}, {}};
  EXPECT_EQ(count(to_svg(plot), "M"), 2U);
  plot.series[0].longest_gap = 0.0;
  EXPECT_EQ(count(to_svg(plot), "M"), 1U);
}

TEST(Plot, ThinsALongSeriesAndKeepsItsExtremes) {
  Series series{"one", "#000", {}};
  for (int i = 0; i < 100000; ++i)
    series.points.push_back({i * 1e-3, i == 54321 ? 7.0 : 0.1 * std::sin(i)});
  const std::string svg = to_svg({"t", "y", {series}, {}, 7.0});
  EXPECT_LT(svg.size(), 60000U);
  EXPECT_THAT(svg, HasSubstr(" 10L"));  // the peak reaches the top of the image
}

TEST(Plot, HasALegendForSeveralSeriesOnly) {
  const Series series{"one", "#000", {{0, 0}, {1, 1}}};
  EXPECT_THAT(to_svg({"t", "y", {series}, {}, {}}), Not(HasSubstr("legend")));
  EXPECT_THAT(to_svg({"t", "y", {series, series}, {}, {}}), HasSubstr("legend"));
}

TEST(Plot, WithoutSeriesIsAnEmptyImage) {
  EXPECT_THAT(to_svg({"t", "y", {}, {}, {}}), HasSubstr("</svg>"));
}

TEST(LogBars, WithoutRowsAreEmpty) {
  EXPECT_EQ(log_bars_svg({{"stage", 0.0, 0.0, 0.0}}, "ms"), "");
  EXPECT_THAT(log_bars_svg({{"stage", 0.01, 0.1, 3.0}}, "ms"), HasSubstr("stage"));
}

}  // namespace
}  // namespace slammot::evaluator
