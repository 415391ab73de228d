#include "common/files/map_image.hpp"

#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

namespace slammot::files {
namespace {

using geometry::Pose2;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// All free but for one occupied cell, and one cell of the MO-map.
flow::Submap room(std::uint32_t columns, std::uint32_t rows) {
  flow::Submap submap;
  submap.cell_size_m = 0.5;
  submap.columns = columns;
  submap.rows = rows;
  submap.so_log_odds.assign(columns * rows, -20);
  submap.mo_evidence.assign(columns * rows, 0);
  return submap;
}

std::uint8_t pixel_at(const MapImage& image, double x_m, double y_m) {
  const auto column = static_cast<std::uint32_t>((x_m - image.min_x_m) / image.resolution_m);
  const auto row_from_below =
      static_cast<std::uint32_t>((y_m - image.min_y_m) / image.resolution_m);
  return image.pixels.at((image.height - 1 - row_from_below) * image.width + column);
}

TEST(DrawMap, PutsACellWhereItIsWithYUp) {
  flow::Submap submap = room(4, 3);
  submap.so_log_odds[0 * 4 + 3] = 40;
  submap.mo_evidence[2 * 4 + 1] = 255;
  const MapImages images = draw_map({{&submap, {}}});
  ASSERT_EQ(images.stationary.width, 4u);
  ASSERT_EQ(images.stationary.height, 3u);
  EXPECT_EQ(pixel_at(images.stationary, 1.75, 0.25), kOccupiedPixel);
  EXPECT_EQ(pixel_at(images.stationary, 0.25, 0.25), kFreePixel);
  EXPECT_EQ(images.stationary.pixels[2 * 4 + 3], kOccupiedPixel);  // lowest row of cells is the
                                                                   // last of pixels
  EXPECT_EQ(pixel_at(images.moving, 0.75, 1.25), kOccupiedPixel);
  EXPECT_EQ(pixel_at(images.moving, 0.25, 0.25), kFreePixel);
}

TEST(DrawMap, FollowsTheSubmapsPose) {
  flow::Submap submap = room(4, 3);
  submap.so_log_odds[3] = 40;
  const Pose2 map_from_submap{10.0, -5.0, std::numbers::pi / 2.0};
  const MapImage image = draw_map({{&submap, map_from_submap}}).stationary;
  const geometry::Vector2 cell_in_map_m = map_from_submap * geometry::Vector2{1.75, 0.25};
  EXPECT_EQ(pixel_at(image, cell_in_map_m.x(), cell_in_map_m.y()), kOccupiedPixel);
  EXPECT_EQ(image.width * image.height, 12u);
}

TEST(DrawMap, AddsTheEvidenceOfOverlappingSubmaps) {
  flow::Submap sure = room(2, 1);
  sure.so_log_odds = {60, -60};
  flow::Submap unsure = room(2, 1);
  unsure.so_log_odds = {-20, 20};
  const MapImage image = draw_map({{&sure, {}}, {&unsure, {}}}).stationary;
  EXPECT_EQ(image.pixels[0], kOccupiedPixel);
  EXPECT_EQ(image.pixels[1], kFreePixel);
}

TEST(DrawMap, CoversJustWhatWasSeen) {
  flow::Submap submap = room(100, 100);
  submap.so_log_odds.assign(100 * 100, 0);
  submap.so_log_odds[50 * 100 + 20] = 40;
  const MapImage image = draw_map({{&submap, {}}}).stationary;
  EXPECT_EQ(image.width, 1u);
  EXPECT_EQ(image.height, 1u);
  EXPECT_DOUBLE_EQ(image.min_x_m, 10.0);
  EXPECT_DOUBLE_EQ(image.min_y_m, 25.0);
}

TEST(DrawMap, DrawsLargeMapsCoarserWithoutLosingThinWalls) {
  flow::Submap submap = room(100, 100);
  for (std::uint32_t row = 0; row < 100; ++row) submap.so_log_odds[row * 100 + 37] = 40;
  const MapImage image = draw_map({{&submap, {}}}, 1'500).stationary;
  EXPECT_LE(image.width * image.height, 1'500u);
  EXPECT_GT(image.resolution_m, 0.5);
  for (double y_m = 0.25; y_m < 50.0; y_m += 0.5)
    EXPECT_EQ(pixel_at(image, 18.75, y_m), kOccupiedPixel);
}

TEST(DrawMap, DrawsNothingAsOneUnknownPixel) {
  const MapImages images = draw_map({});
  EXPECT_THAT(images.stationary.pixels, ::testing::ElementsAre(kUnknownPixel));
  EXPECT_THAT(images.moving.pixels, ::testing::ElementsAre(kUnknownPixel));
}

const MapImage kImage{3, 2, 0.05, -1.5, 2.25, {0, 205, 254, 254, 205, 0}};

TEST(MapFiles, ArePortableGreyMaps) {
  EXPECT_EQ(to_pgm(kImage), std::string("P5\n3 2\n255\n\x00\xcd\xfe\xfe\xcd\x00", 17));
}

TEST(MapFiles, ArePicturesThatLibpngReadsBack) {
  const auto png = to_png(kImage);
  ASSERT_TRUE(png);
  EXPECT_THAT(*png, StartsWith("\x89PNG"));
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, png->data(), png->size()));
  image.format = PNG_FORMAT_GRAY;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels, kImage.pixels);
}

TEST(MapFiles, TellMapServerWhereThePictureLies) {
  EXPECT_EQ(to_map_server_yaml(kImage, "map.pgm"),
            "image: map.pgm\nresolution: 0.050000\norigin: [-1.500000, 2.250000, 0.0]\nnegate: "
            "0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

}  // namespace
}  // namespace slammot::files
