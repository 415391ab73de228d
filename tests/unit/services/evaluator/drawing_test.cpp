#include "services/evaluator/drawing.hpp"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/evaluator/page_theme.hpp"
#include "services/evaluator/stroke_font.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr files::Rgb kRed = {255, 0, 0};
constexpr files::Rgb kWhite = {255, 255, 255};

files::Rgb pixel(const files::RgbImage& image, std::uint32_t x, std::uint32_t y) {
  return image.pixels[std::size_t{y} * image.width + x];
}

TEST(Pixels, FillAnAreaToItsEdgesInProportion) {
  Drawing drawing{8.0, 8.0, kWhite, {}};
  drawing.marks.emplace_back(
      AreaMark{{{2.0, 2.0}, {5.5, 2.0}, {5.5, 6.0}, {2.0, 6.0}}, {kRed, 1.0}});
  const files::RgbImage image = to_pixels(drawing, 1.0);
  EXPECT_EQ(pixel(image, 3, 3), kRed);
  EXPECT_EQ(pixel(image, 1, 3), kWhite);
  EXPECT_NEAR(pixel(image, 5, 3)[1], 127, 2);  // half covered
}

TEST(Pixels, DrawALineOfItsWidth) {
  Drawing drawing{20.0, 9.0, kWhite, {}};
  drawing.marks.emplace_back(LineMark{{{2.0, 4.5}, {18.0, 4.5}}, {kRed, 1.0}, 3.0});
  const files::RgbImage image = to_pixels(drawing, 1.0);
  EXPECT_EQ(pixel(image, 10, 4), kRed);
  EXPECT_EQ(pixel(image, 10, 3), kRed);
  EXPECT_EQ(pixel(image, 10, 1), kWhite);
}

TEST(Pixels, ALineThatCrossesItselfIsNoDarkerThere) {
  Drawing drawing{20.0, 20.0, kWhite, {}};
  drawing.marks.emplace_back(
      LineMark{{{0.0, 10.5}, {20.0, 10.5}, {10.5, 10.5}, {10.5, 20.0}}, {kRed, 0.5}, 3.0});
  const files::RgbImage image = to_pixels(drawing, 1.0);
  EXPECT_EQ(pixel(image, 10, 10), pixel(image, 2, 10));
}

TEST(Pixels, SurviveMarksOutsideOfThePicture) {
  Drawing drawing{10.0, 10.0, kWhite, {}};
  drawing.marks.emplace_back(LineMark{{{-1e7, -1e7}, {1e7, 1e7}}, {kRed}, 1.0});
  drawing.marks.emplace_back(AreaMark{{{-1e9, -5.0}, {-1e8, -5.0}, {-1e8, 1e9}}, {kRed}});
  drawing.marks.emplace_back(TextMark{{500.0, 500.0}, "out", {kRed}});
  const files::RgbImage image = to_pixels(drawing, 1.0);
  EXPECT_NE(pixel(image, 5, 5), kWhite);
  EXPECT_EQ(pixel(image, 9, 0), kWhite);
}

TEST(Svg, EscapesTextAndNeedsNoOtherFile) {
  Drawing drawing{10.0, 10.0, kWhite, {}};
  drawing.marks.emplace_back(TextMark{{1.0, 9.0}, "a < b", {kRed}});
  EXPECT_THAT(to_svg(drawing), HasSubstr(">a &lt; b</text>"));
  EXPECT_THAT(to_svg(drawing), Not(HasSubstr("url(")));
}

/// Corners of all strokes, for comparison.
std::vector<std::pair<double, double>> corners(const std::string& text) {
  std::vector<std::pair<double, double>> corners;
  for (const FontStroke& stroke : strokes_of(text))
    for (const FontPoint& point : stroke) corners.emplace_back(point.x, point.y);
  return corners;
}

TEST(StrokeFont, HasEveryCharacterOfLabels) {
  const auto unknown = corners("\x01");
  for (const char letter : std::string("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                       "0123456789.,:;-+/()[]%_=<>"))
    EXPECT_NE(corners(std::string(1, letter)), unknown) << letter;
}

TEST(StrokeFont, PutsLettersSideBySide) {
  EXPECT_GT(width_of("mm"), 2.0 * width_of("m"));
  EXPECT_GT(strokes_of("ll")[1].front().x, width_of("l"));
}

TEST(PageTheme, ReadsTheColoursOfTheLivePage) {
  const PageTheme theme = theme_in(
      "export const THEMES = {\n  dark: all({\n    back: \"#0a0e14\", wall: \"#a9d3f2\",\n  }),\n"
      "  light: all({\n    back: \"#ffffff\",\n  }),\n};",
      "dark");
  ASSERT_EQ(theme.size(), 2U);
  EXPECT_EQ(theme.at("back"), (files::Rgb{0x0a, 0x0e, 0x14}));
  EXPECT_EQ(theme.at("wall"), (files::Rgb{0xa9, 0xd3, 0xf2}));
}

TEST(PageTheme, HasAllColoursThatPicturesNeed) {
  for (const char* const name : {"dark", "light"}) {
    const PageTheme theme = page_theme(name);
    for (const char* const colour : {"back", "free", "wall", "motion", "vehicle", "way", "accepted",
                                     "car", "truck", "pedestrian", "bicycle", "other"})
      EXPECT_TRUE(theme.contains(colour)) << name << " " << colour;
  }
}

}  // namespace
}  // namespace slammot::evaluator
