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

}  // namespace

Result<std::string> to_png(const IndexedImage& image, int compression) {
  assert(!image.palette.empty() && image.palette.size() <= 256);
  assert(image.pixels.size() == std::size_t{image.width} * image.height);
  std::string bytes;
  std::vector<png_color> colours;
  for (const Rgb& colour : image.palette) colours.push_back({colour[0], colour[1], colour[2]});
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) return Error{"libpng cannot start"};
  if (setjmp(png_jmpbuf(png)) != 0) {  // libpng's error handling
    png_destroy_write_struct(&png, &info);
    return Error{"libpng cannot draw a picture of " + std::to_string(image.width) + " x " +
                 std::to_string(image.height)};
  }
  png_set_write_fn(png, &bytes, append_to_string, flush_nothing);
  png_set_compression_level(png, compression);
  png_set_filter(png, 0, PNG_FILTER_NONE);  // Indices are no intensities: filters add size.
  png_set_IHDR(png, info, image.width, image.height, 8, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_PLTE(png, info, colours.data(), static_cast<int>(colours.size()));
  png_write_info(png, info);
  for (std::uint32_t row = 0; row < image.height; ++row)
    png_write_row(png, image.pixels.data() + std::size_t{row} * image.width);
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

}  // namespace slammot::files
