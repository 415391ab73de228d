#include "common/files/ply_file.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

PlyModel one_quad() {
  PlyModel model;
  for (const float x_m : {0.0F, 1.0F, 1.5F, -2.25F})
    model.vertices.push_back({{x_m, 2.0F, -3.5F}, {10, 20, 30}});
  model.quads.push_back({0, 1, 2, 3});
  return model;
}

TEST(PlyFile, IsReadAsItWasWritten) {
  const auto back = parse_ply(to_ply(one_quad()), "a.ply");
  ASSERT_TRUE(back);
  ASSERT_EQ(back->vertices.size(), 4U);
  EXPECT_EQ(back->vertices[3].position_m, one_quad().vertices[3].position_m);
  EXPECT_EQ(back->vertices[3].colour, (Rgb{10, 20, 30}));
  EXPECT_EQ(back->quads, one_quad().quads);
}

TEST(PlyFile, HasTheHeaderOfBinaryPointsWhereThereAreNoFaces) {
  PlyModel points = one_quad();
  points.quads.clear();
  const std::string bytes = to_ply(points);
  EXPECT_TRUE(bytes.starts_with("ply\nformat binary_little_endian 1.0\nelement vertex 4\n"));
  EXPECT_EQ(bytes.find("face"), std::string::npos);
  EXPECT_EQ(bytes.size() - bytes.find("end_header\n") - 11, 4U * 15U);
  EXPECT_TRUE(parse_ply(bytes, "points.ply"));
}

TEST(PlyFile, IsRefusedWhereItIsCutOrInconsistent) {
  const std::string bytes = to_ply(one_quad());
  for (const std::size_t length : {std::size_t{0}, std::size_t{10}, bytes.size() - 1})
    EXPECT_FALSE(parse_ply(bytes.substr(0, length), "a.ply"));
  EXPECT_FALSE(parse_ply(bytes + "x", "a.ply"));
  PlyModel model = one_quad();
  model.quads[0][2] = 4;
  EXPECT_FALSE(parse_ply(to_ply(model), "a.ply"));
  model = one_quad();
  model.vertices[0].position_m[1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(parse_ply(to_ply(model), "a.ply"));
}

TEST(PlyFile, OfHugeCountsIsRefusedWithoutAllocating) {
  std::string bytes = to_ply(one_quad());
  bytes.replace(bytes.find("vertex 4"), 8, "vertex 18446744073709551615");
  EXPECT_FALSE(parse_ply(bytes, "a.ply"));
}

}  // namespace
}  // namespace slammot::files
