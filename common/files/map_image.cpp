#include "common/files/map_image.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/files/decimal.hpp"
#include "common/files/png_image.hpp"

namespace slammot::files {
namespace {

using geometry::Pose2;
using geometry::Vector2;

// In 1/16 of log-odds. map_server's threshold for occupied is probability 0.65, log-odds 0.62. The
// threshold for free needs less evidence than that convention's 0.196: far cells often have only
// one scan's beam.
constexpr int kOccupiedFrom = 10;
constexpr int kFreeFrom = -6;
constexpr double kDefaultResolutionM = 0.1;

struct Box {
  double min_x_m = std::numeric_limits<double>::infinity();
  double min_y_m = std::numeric_limits<double>::infinity();
  double max_x_m = -std::numeric_limits<double>::infinity();
  double max_y_m = -std::numeric_limits<double>::infinity();

  bool is_empty() const { return min_x_m > max_x_m; }
  void include(const Vector2& point_m) {
    min_x_m = std::min(min_x_m, point_m.x());
    min_y_m = std::min(min_y_m, point_m.y());
    max_x_m = std::max(max_x_m, point_m.x());
    max_y_m = std::max(max_y_m, point_m.y());
  }
};

bool is_seen(const flow::Submap& submap, std::size_t cell) {
  return submap.so_log_odds[cell] != 0 ||
         (cell < submap.mo_evidence.size() && submap.mo_evidence[cell] != 0);
}

/// Bounding box of the seen part of the submap, in its own frame.
Box seen_part(const flow::Submap& submap) {
  Box box;
  for (std::uint32_t row = 0; row < submap.rows; ++row) {
    const auto seen = [&](std::uint32_t column) {
      return is_seen(submap, std::size_t{row} * submap.columns + column);
    };
    std::uint32_t first = 0;
    while (first < submap.columns && !seen(first)) ++first;
    if (first == submap.columns) continue;
    std::uint32_t last = submap.columns - 1;
    while (!seen(last)) --last;
    for (const std::uint32_t column : {first, last}) {
      const Vector2 corner_m{submap.min_x_m + column * submap.cell_size_m,
                             submap.min_y_m + row * submap.cell_size_m};
      box.include(corner_m);
      box.include(corner_m + Vector2::Constant(submap.cell_size_m));
    }
  }
  return box;
}

Box in_map(const Box& box_in_submap, const Pose2& map_from_submap) {
  Box box;
  if (box_in_submap.is_empty()) return box;
  for (const double x_m : {box_in_submap.min_x_m, box_in_submap.max_x_m}) {
    for (const double y_m : {box_in_submap.min_y_m, box_in_submap.max_y_m})
      box.include(map_from_submap * Vector2{x_m, y_m});
  }
  return box;
}

/// Sums over all submaps; row 0 is the lowest.
struct Canvas {
  std::int64_t columns = 1;
  std::int64_t rows = 1;
  double resolution_m = kDefaultResolutionM;
  double min_x_m = 0.0;
  double min_y_m = 0.0;
  int samples = 1;  // samples per pixel and axis, so that a pixel larger than a cell misses no thin
                    // wall
  std::vector<std::int16_t> log_odds;
  std::vector<std::uint8_t> moving;
  std::vector<std::uint8_t> seen;
};

Canvas blank_canvas(const Box& box, double cell_size_m, std::uint64_t max_pixels) {
  Canvas canvas;
  canvas.resolution_m = cell_size_m;
  if (!box.is_empty()) {
    for (canvas.samples = 1;; ++canvas.samples) {
      canvas.resolution_m = cell_size_m * canvas.samples;
      // Corners on multiples of the resolution: pixels of two runs are aligned.
      canvas.min_x_m = std::floor(box.min_x_m / canvas.resolution_m) * canvas.resolution_m;
      canvas.min_y_m = std::floor(box.min_y_m / canvas.resolution_m) * canvas.resolution_m;
      const double columns = std::ceil((box.max_x_m - canvas.min_x_m) / canvas.resolution_m);
      const double rows = std::ceil((box.max_y_m - canvas.min_y_m) / canvas.resolution_m);
      if (std::max(columns, 1.0) * std::max(rows, 1.0) > static_cast<double>(max_pixels)) continue;
      canvas.columns = std::max<std::int64_t>(1, static_cast<std::int64_t>(columns));
      canvas.rows = std::max<std::int64_t>(1, static_cast<std::int64_t>(rows));
      break;
    }
  }
  const auto pixels = static_cast<std::size_t>(canvas.columns * canvas.rows);
  canvas.log_odds.resize(pixels);
  canvas.moving.resize(pixels);
  canvas.seen.resize(pixels);
  return canvas;
}

struct Sample {
  int log_odds = 0;
  int moving = 0;
  bool seen = false;
};

/// Submap evidence for a pixel around this point: the most occupied cell, otherwise the least free
/// one.
Sample look(const flow::Submap& submap, const Vector2& centre_in_submap_m, const Canvas& canvas,
            const geometry::Matrix2& submap_from_map) {
  Sample result;
  const double pitch_m = canvas.resolution_m / canvas.samples;
  for (int i = 0; i < canvas.samples; ++i) {
    for (int j = 0; j < canvas.samples; ++j) {
      const double half = 0.5 * (canvas.samples - 1);
      const Vector2 point_m = centre_in_submap_m +
                              submap_from_map * Vector2{(i - half) * pitch_m, (j - half) * pitch_m};
      const double column = (point_m.x() - submap.min_x_m) / submap.cell_size_m;
      const double row = (point_m.y() - submap.min_y_m) / submap.cell_size_m;
      if (!(column >= 0.0 && row >= 0.0 && column < submap.columns && row < submap.rows)) continue;
      const auto cell = static_cast<std::size_t>(static_cast<std::int64_t>(row) * submap.columns +
                                                 static_cast<std::int64_t>(column));
      if (!is_seen(submap, cell)) continue;
      result.log_odds = result.seen ? std::max<int>(result.log_odds, submap.so_log_odds[cell])
                                    : submap.so_log_odds[cell];
      if (cell < submap.mo_evidence.size())
        result.moving = std::max<int>(result.moving, submap.mo_evidence[cell]);
      result.seen = true;
    }
  }
  return result;
}

void add_to_pixel(Canvas& canvas, std::size_t pixel, const Sample& sample) {
  canvas.log_odds[pixel] = static_cast<std::int16_t>(
      std::clamp(canvas.log_odds[pixel] + sample.log_odds, -30'000, 30'000));
  canvas.moving[pixel] =
      static_cast<std::uint8_t>(std::max<int>(canvas.moving[pixel], sample.moving));
  canvas.seen[pixel] = 1;
}

/// Pixels [first, end) of a row of the canvas with one sample each: cell indices are computed in
/// advance, vectorized.
class SingleLook {
 public:
  SingleLook(const PlacedSubmap& placed, Canvas& canvas, std::int64_t first_column,
             std::int64_t end_column)
      : submap_(*placed.submap),
        canvas_(canvas),
        first_column_(first_column),
        along_x_(static_cast<std::size_t>(end_column - first_column)),
        along_y_(along_x_.size()),
        cells_(along_x_.size()) {
    const Pose2 submap_from_map = inverse(placed.map_from_submap);
    turn_ = geometry::rotation(submap_from_map.heading_rad);
    origin_m_ = submap_from_map.translation_m();
    for (std::size_t i = 0; i < along_x_.size(); ++i) {
      const double x_m = canvas.min_x_m +
                         (static_cast<double>(first_column + static_cast<std::int64_t>(i)) + 0.5) *
                             canvas.resolution_m;
      along_x_[i] = turn_(0, 0) * x_m;
      along_y_[i] = turn_(1, 0) * x_m;
    }
  }

  void add_row(std::int64_t row) {
    const double y_m = canvas_.min_y_m + (static_cast<double>(row) + 0.5) * canvas_.resolution_m;
    const double across_x = turn_(0, 1) * y_m;
    const double across_y = turn_(1, 1) * y_m;
    const double columns = submap_.columns;
    const double rows = submap_.rows;
    const auto columns_in_row = static_cast<std::int32_t>(submap_.columns);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const double column =
          (along_x_[i] + across_x + origin_m_.x() - submap_.min_x_m) / submap_.cell_size_m;
      const double row_in_submap =
          (along_y_[i] + across_y + origin_m_.y() - submap_.min_y_m) / submap_.cell_size_m;
      const bool is_inside =
          (column >= 0.0) & (row_in_submap >= 0.0) & (column < columns) & (row_in_submap < rows);
      const std::int32_t cell =
          static_cast<std::int32_t>(is_inside ? row_in_submap : 0.0) * columns_in_row +
          static_cast<std::int32_t>(is_inside ? column : 0.0);
      cells_[i] = is_inside ? cell : -1;
    }
    const std::size_t first_pixel = static_cast<std::size_t>(row * canvas_.columns + first_column_);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      if (cells_[i] < 0) continue;
      const auto cell = static_cast<std::size_t>(cells_[i]);
      if (!is_seen(submap_, cell)) continue;
      add_to_pixel(canvas_, first_pixel + i,
                   {submap_.so_log_odds[cell],
                    cell < submap_.mo_evidence.size() ? submap_.mo_evidence[cell] : 0, true});
    }
  }

 private:
  const flow::Submap& submap_;
  Canvas& canvas_;
  std::int64_t first_column_;
  geometry::Matrix2 turn_;
  Vector2 origin_m_;
  std::vector<double> along_x_;  ///< Contribution of a column to both coordinates in the submap.
  std::vector<double> along_y_;
  std::vector<std::int32_t> cells_;  ///< -1 outside.
};

void add_to_canvas(const PlacedSubmap& placed, const Box& box_in_map, Canvas& canvas) {
  if (box_in_map.is_empty()) return;
  const auto column_of = [&](double x_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>((x_m - canvas.min_x_m) / canvas.resolution_m), 0,
        canvas.columns - 1);
  };
  const auto row_of = [&](double y_m) {
    return std::clamp<std::int64_t>(
        static_cast<std::int64_t>((y_m - canvas.min_y_m) / canvas.resolution_m), 0,
        canvas.rows - 1);
  };
  const std::int64_t first_column = column_of(box_in_map.min_x_m);
  const std::int64_t end_column = column_of(box_in_map.max_x_m) + 1;
  const std::int64_t first_row = row_of(box_in_map.min_y_m);
  const std::int64_t end_row = row_of(box_in_map.max_y_m) + 1;
  const bool fits = std::uint64_t{placed.submap->columns} * placed.submap->rows <=
                    std::numeric_limits<std::int32_t>::max();
  if (canvas.samples == 1 && fits) {
    SingleLook look_at(placed, canvas, first_column, end_column);
    for (std::int64_t row = first_row; row < end_row; ++row) look_at.add_row(row);
    return;
  }
  const Pose2 submap_from_map = inverse(placed.map_from_submap);
  const geometry::Matrix2 turn = geometry::rotation(submap_from_map.heading_rad);
  for (std::int64_t row = first_row; row < end_row; ++row) {
    for (std::int64_t column = first_column; column < end_column; ++column) {
      const Vector2 centre_in_map_m{
          canvas.min_x_m + (static_cast<double>(column) + 0.5) * canvas.resolution_m,
          canvas.min_y_m + (static_cast<double>(row) + 0.5) * canvas.resolution_m};
      const Sample sample = look(
          *placed.submap, turn * centre_in_map_m + submap_from_map.translation_m(), canvas, turn);
      if (sample.seen)
        add_to_pixel(canvas, static_cast<std::size_t>(row * canvas.columns + column), sample);
    }
  }
}

std::uint8_t stationary_pixel(int log_odds) {
  if (log_odds >= kOccupiedFrom) return kOccupiedPixel;
  return log_odds <= kFreeFrom ? kFreePixel : kUnknownPixel;
}

std::uint8_t moving_pixel(bool seen, int evidence) {
  if (!seen) return kUnknownPixel;
  const int pixel = kFreePixel - kFreePixel * evidence / 255;
  return static_cast<std::uint8_t>(pixel == kUnknownPixel ? pixel - 1 : pixel);
}

/// Flipped: canvas row 0 is the lowest, an image's row 0 the topmost.
template <typename PixelOf>
MapImage image_of(const Canvas& canvas, PixelOf pixel_of) {
  MapImage image{static_cast<std::uint32_t>(canvas.columns),
                 static_cast<std::uint32_t>(canvas.rows),
                 canvas.resolution_m,
                 canvas.min_x_m,
                 canvas.min_y_m,
                 {}};
  image.pixels.resize(canvas.seen.size());
  const auto columns = static_cast<std::size_t>(canvas.columns);
  for (std::size_t row = 0, from_below = static_cast<std::size_t>(canvas.rows);
       row < static_cast<std::size_t>(canvas.rows); ++row) {
    --from_below;
    for (std::size_t column = 0; column < columns; ++column)
      image.pixels[row * columns + column] = pixel_of(from_below * columns + column);
  }
  return image;
}

}  // namespace

MapImages draw_map(const std::vector<PlacedSubmap>& submaps, std::uint64_t max_pixels) {
  double cell_size_m = std::numeric_limits<double>::infinity();
  std::vector<Box> boxes;
  Box whole;
  for (const PlacedSubmap& placed : submaps) {
    assert(placed.submap->so_log_odds.size() ==
           std::size_t{placed.submap->columns} * placed.submap->rows);
    boxes.push_back(in_map(seen_part(*placed.submap), placed.map_from_submap));
    if (boxes.back().is_empty()) continue;
    cell_size_m = std::min(cell_size_m, placed.submap->cell_size_m);
    whole.include({boxes.back().min_x_m, boxes.back().min_y_m});
    whole.include({boxes.back().max_x_m, boxes.back().max_y_m});
  }
  Canvas canvas = blank_canvas(
      whole, std::isfinite(cell_size_m) ? cell_size_m : kDefaultResolutionM, max_pixels);
  for (std::size_t i = 0; i < submaps.size(); ++i) add_to_canvas(submaps[i], boxes[i], canvas);
  return {
      image_of(canvas, [&](std::size_t pixel) { return stationary_pixel(canvas.log_odds[pixel]); }),
      image_of(canvas, [&](std::size_t pixel) {
        return moving_pixel(canvas.seen[pixel] != 0, canvas.moving[pixel]);
      })};
}

std::string to_pgm(const MapImage& image) {
  std::string pgm =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  return pgm.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size());
}

Result<std::string> to_png(const MapImage& image) {
  constexpr int kCompression = 3;
  return to_png(GreyImage{image.width, image.height, image.pixels}, kCompression);
}

std::string to_map_server_yaml(const MapImage& image, const std::string& image_file) {
  return "image: " + image_file + "\nresolution: " + fixed_text(image.resolution_m, 6) +
         "\norigin: [" + fixed_text(image.min_x_m, 6) + ", " + fixed_text(image.min_y_m, 6) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

}  // namespace slammot::files
