#include "common/files/png_image.hpp"

#include <cassert>
#include <csetjmp>

#include <png.h>

namespace slammot::files {
namespace {

void append_to_string(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), count);
}

void flush_nothing(png_structp) {}

/// What differs between kinds of pictures.
struct Kind {
  int colour_type = PNG_COLOR_TYPE_RGB;
  int filters = PNG_ALL_FILTERS;
  std::vector<png_color> palette{};
};

template <typename Pixel>
Result<std::string> write(std::uint32_t width, std::uint32_t height, std::span<const Pixel> pixels,
                          const Kind& kind, int compression) {
  assert(pixels.size() == std::size_t{width} * height);
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) return Error{"libpng cannot start"};
  if (setjmp(png_jmpbuf(png)) != 0) {  // libpng's error handling
    png_destroy_write_struct(&png, &info);
    return Error{"libpng cannot draw a picture of " + std::to_string(width) + " x " +
                 std::to_string(height)};
  }
  png_set_write_fn(png, &bytes, append_to_string, flush_nothing);
  png_set_compression_level(png, compression);
  png_set_filter(png, 0, kind.filters);
  png_set_IHDR(png, info, width, height, 8, kind.colour_type, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!kind.palette.empty())
    png_set_PLTE(png, info, kind.palette.data(), static_cast<int>(kind.palette.size()));
  png_write_info(png, info);
  for (std::uint32_t row = 0; row < height; ++row)
    png_write_row(png, reinterpret_cast<png_const_bytep>(pixels.data() + std::size_t{row} * width));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace

Result<std::string> to_png(const IndexedImage& image, int compression) {
  assert(!image.palette.empty() && image.palette.size() <= 256);
  Kind kind{PNG_COLOR_TYPE_PALETTE, PNG_FILTER_NONE, {}};  // Indices are no intensities.
  for (const Rgb& colour : image.palette) kind.palette.push_back({colour[0], colour[1], colour[2]});
  return write<std::uint8_t>(image.width, image.height, image.pixels, kind, compression);
}

Result<std::string> to_png(const RgbImage& image, int compression) {
  return write<Rgb>(image.width, image.height, image.pixels, {}, compression);
}

Result<std::string> to_png(const GreyImage& image, int compression) {
  const Kind kind{PNG_COLOR_TYPE_GRAY, PNG_FILTER_NONE, {}};  // Filters would increase the size.
  return write(image.width, image.height, image.pixels, kind, compression);
}

}  // namespace slammot::files
