#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "common/files/png_image.hpp"
#include "services/evaluator/svg_plot.hpp"

namespace slammot::evaluator {

struct Ink {
  files::Rgb colour = {};
  double opacity = 1.0;
};

struct LineMark {
  std::vector<PlotPoint> points;  ///< One point: a dot.
  Ink ink;
  double width = 1.0;
  bool is_dashed = false;
};

struct AreaMark {
  std::vector<PlotPoint> points;  ///< Corners.
  Ink ink;
};

enum class Anchor { kStart, kMiddle, kEnd };

struct TextMark {
  PlotPoint at;  ///< On the baseline.
  std::string text;
  Ink ink;
  double size = 12.0;  ///< Of the font; capitals have 0.7 of it.
  Anchor anchor = Anchor::kStart;
  bool is_upward = false;  ///< Turned to read from below.
};

struct ImageMark {
  std::shared_ptr<const files::IndexedImage> image;  ///< Not null.
  PlotPoint at;                                      ///< Upper left corner.
  double width = 0.0;
  double height = 0.0;
};

using Mark = std::variant<LineMark, AreaMark, TextMark, ImageMark>;

/// What is drawn, in its order; x to the right, y down, unit: a pixel of a screen.
struct Drawing {
  double width = 0.0;
  double height = 0.0;
  files::Rgb background = {255, 255, 255};
  std::vector<Mark> marks;
};

/// An SVG file that needs no other one.
std::string to_svg(const Drawing& drawing);

/// Pixels, `scale` for each unit along both axes, with smooth edges.
files::RgbImage to_pixels(const Drawing& drawing, double scale);

}  // namespace slammot::evaluator
