#include <algorithm>
#include <cmath>

#include "services/evaluator/drawing.hpp"
#include "services/evaluator/stroke_font.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kCapitals = 0.7;  // of the size of a font
constexpr double kDash = 6.0;
constexpr double kDashGap = 4.0;
constexpr int kSubRows = 4;  // of a row of pixels, for the edges of areas

/// Draws with coverage: each mark is first a mask, so that a line is not darker where it meets
/// itself.
class Raster {
 public:
  Raster(const Drawing& drawing, double scale) : scale_(scale) {
    image_.width = static_cast<std::uint32_t>(std::lround(std::ceil(drawing.width * scale)));
    image_.height = static_cast<std::uint32_t>(std::lround(std::ceil(drawing.height * scale)));
    image_.pixels.assign(std::size_t{image_.width} * image_.height, drawing.background);
    mask_.resize(image_.pixels.size());
  }

  void operator()(const LineMark& line) {
    add_path(line.points, line.width, line.is_dashed);
    blend(line.ink);
  }
  void operator()(const AreaMark& area) {
    fill(area.points);
    blend(area.ink);
  }
  void operator()(const TextMark& text) {
    const double height = kCapitals * text.size;
    const double width = width_of(text.text) * height;
    const double shift = text.anchor == Anchor::kStart    ? 0.0
                         : text.anchor == Anchor::kMiddle ? -0.5 * width
                                                          : -width;
    for (const FontStroke& stroke : strokes_of(text.text)) {
      std::vector<PlotPoint> points;
      for (const FontPoint& point : stroke) {
        const double along = shift + point.x * height;
        const double up = point.y * height;
        if (text.is_upward) points.push_back({text.at.x - up, text.at.y - along});
        else points.push_back({text.at.x + along, text.at.y - up});
      }
      add_path(points, 0.09 * text.size, false);
    }
    blend(text.ink);
  }
  void operator()(const ImageMark& mark) {
    const files::IndexedImage& image = *mark.image;
    const double right = mark.width * scale_;
    const double down = mark.height * scale_;
    const double left = mark.at.x * scale_;
    const double top = mark.at.y * scale_;
    for (std::int64_t y = row(top); y < row(top + down); ++y) {
      const auto from_y =
          static_cast<std::int64_t>((static_cast<double>(y) + 0.5 - top) / down * image.height);
      for (std::int64_t x = column(left); x < column(left + right); ++x) {
        const auto from_x =
            static_cast<std::int64_t>((static_cast<double>(x) + 0.5 - left) / right * image.width);
        if (from_x < 0 || from_y < 0 || from_x >= image.width || from_y >= image.height) continue;
        image_.pixels[static_cast<std::size_t>(y * image_.width + x)] =
            image.palette[image.pixels[static_cast<std::size_t>(from_y * image.width + from_x)]];
      }
    }
  }

  files::RgbImage take() { return std::move(image_); }

 private:
  std::int64_t column(double x) const {
    return std::clamp<std::int64_t>(std::llround(x), 0, image_.width);
  }
  std::int64_t row(double y) const {
    return std::clamp<std::int64_t>(std::llround(y), 0, image_.height);
  }

  void add_path(const std::vector<PlotPoint>& points, double width, bool is_dashed) {
    const double half = 0.5 * std::max(1.0, width * scale_);
    if (points.size() == 1) add_segment(points[0], points[0], half);
    double done = 0.0;  // along the path, for dashes
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (is_dashed) done = add_dashes(points[i - 1], points[i], half, done);
      else add_segment(points[i - 1], points[i], half);
    }
  }

  double add_dashes(const PlotPoint& a, const PlotPoint& b, double half, double done) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const auto at = [&](double along) {
      return PlotPoint{a.x + (b.x - a.x) * along / length, a.y + (b.y - a.y) * along / length};
    };
    for (double along = 0.0; along < length;) {
      const double phase = std::fmod(done + along, kDash + kDashGap);
      const double end =
          std::min(length, along + (phase < kDash ? kDash : kDash + kDashGap) - phase);
      if (phase < kDash) add_segment(at(along), at(end), half);
      along = std::max(end, along + 1e-6);
    }
    return done + length;
  }

  /// Coverage of pixels by a segment with round ends, from their distance to it.
  void add_segment(const PlotPoint& from, const PlotPoint& to, double half) {
    const PlotPoint a{from.x * scale_, from.y * scale_};
    const PlotPoint b{to.x * scale_, to.y * scale_};
    if (!std::isfinite(a.x + a.y + b.x + b.y)) return;
    const double reach = half + 1.0;
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double squared = dx * dx + dy * dy;
    const std::int64_t end_x = column(std::max(a.x, b.x) + reach);
    const std::int64_t end_y = row(std::max(a.y, b.y) + reach);
    const std::int64_t begin_x = column(std::min(a.x, b.x) - reach);
    for (std::int64_t y = row(std::min(a.y, b.y) - reach); y < end_y; ++y) {
      for (std::int64_t x = begin_x; x < end_x; ++x) {
        const double px = static_cast<double>(x) + 0.5 - a.x;
        const double py = static_cast<double>(y) + 0.5 - a.y;
        const double part =
            squared > 0.0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0.0;
        const double away = std::hypot(px - part * dx, py - part * dy);
        cover(x, y, std::clamp(half + 0.5 - away, 0.0, 1.0));
      }
    }
  }

  void cover(std::int64_t x, std::int64_t y, double share) {
    const auto level = static_cast<std::uint8_t>(std::lround(255.0 * share));
    if (level == 0) return;
    const auto pixel = static_cast<std::size_t>(y * image_.width + x);
    if (mask_[pixel] == 0) touched_.push_back(pixel);
    mask_[pixel] = std::max(mask_[pixel], level);
  }

  /// Where edges cross a horizontal line, ascending.
  std::vector<double> crossings(const std::vector<PlotPoint>& corners, double y) const {
    std::vector<double> at;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const PlotPoint& a = corners[i];
      const PlotPoint& b = corners[(i + 1) % corners.size()];
      if ((a.y * scale_ <= y) == (b.y * scale_ <= y)) continue;
      at.push_back(scale_ * a.x + (y - scale_ * a.y) / (b.y - a.y) * (b.x - a.x));
    }
    std::ranges::sort(at);
    return at;
  }

  void fill(const std::vector<PlotPoint>& corners) {
    double low = static_cast<double>(image_.height);
    double high = 0.0;
    for (const PlotPoint& corner : corners) {
      low = std::min(low, corner.y * scale_);
      high = std::max(high, corner.y * scale_);
    }
    std::vector<double> shares(image_.width);
    for (std::int64_t y = row(low - 1.0); y < row(high + 1.0); ++y) {
      std::ranges::fill(shares, 0.0);
      for (int sub = 0; sub < kSubRows; ++sub) {
        const auto at = crossings(corners, static_cast<double>(y) + (sub + 0.5) / kSubRows);
        for (std::size_t i = 1; i < at.size(); i += 2) add_span(at[i - 1], at[i], shares);
      }
      for (std::size_t x = 0; x < shares.size(); ++x)
        if (shares[x] > 0.0) cover(static_cast<std::int64_t>(x), y, std::min(1.0, shares[x]));
    }
  }

  void add_span(double from, double to, std::vector<double>& shares) const {
    const double end = static_cast<double>(image_.width);
    from = std::clamp(from, 0.0, end);
    to = std::clamp(to, 0.0, end);
    for (auto x = static_cast<std::size_t>(from); x < shares.size() && static_cast<double>(x) < to;
         ++x) {
      const double left = std::max(from, static_cast<double>(x));
      const double right = std::min(to, static_cast<double>(x) + 1.0);
      shares[x] += (right - left) / kSubRows;
    }
  }

  void blend(const Ink& ink) {
    for (const std::size_t pixel : touched_) {
      const double share = ink.opacity * mask_[pixel] / 255.0;
      for (std::size_t i = 0; i < 3; ++i) {
        std::uint8_t& value = image_.pixels[pixel][i];
        value = static_cast<std::uint8_t>(
            std::lround(value + share * (static_cast<double>(ink.colour[i]) - value)));
      }
      mask_[pixel] = 0;
    }
    touched_.clear();
  }

  double scale_;
  files::RgbImage image_;
  std::vector<std::uint8_t> mask_;  ///< Coverage by the present mark; 0 outside of touched_.
  std::vector<std::size_t> touched_;
};

}  // namespace

files::RgbImage to_pixels(const Drawing& drawing, double scale) {
  Raster raster(drawing, scale);
  for (const Mark& mark : drawing.marks) std::visit(raster, mark);
  return raster.take();
}

}  // namespace slammot::evaluator
