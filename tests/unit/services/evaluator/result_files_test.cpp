#include "services/evaluator/result_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/evaluator/scene_drawing.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;

class ResultFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "online.tum", straight_tum(0.0));
    write(folder_ / "trajectory.tum", straight_tum(0.0));
  }
  testing::TemporaryFolder folder_;
};

TEST_F(ResultFiles, NeedTheTrajectoriesOnly) {
  const auto result = read_result(folder_.path());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->tracks.empty());
  EXPECT_FALSE(result->map);
}

TEST_F(ResultFiles, JoinTracksWithTheirCovariances) {
  write(folder_ / "tracks.csv", tracks_csv(0.0, 0.0));
  write(folder_ / "track_details.csv",
        "timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy\n0.100000,7,0.04,0.01,0.09,1,"
        "0,1\n");
  const auto result = read_result(folder_.path());
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->tracks[0].tracks[0].position_covariance_m2);
  ASSERT_TRUE(result->tracks[1].tracks[0].position_covariance_m2);
  ASSERT_TRUE(result->tracks[1].tracks[0].velocity_covariance_m2ps2);
  EXPECT_EQ((*result->tracks[1].tracks[0].velocity_covariance_m2ps2)(0, 0), 1.0);
  EXPECT_EQ((*result->tracks[1].tracks[0].velocity_covariance_m2ps2)(1, 1), 1.0);
  EXPECT_EQ((*result->tracks[1].tracks[0].position_covariance_m2)(0, 1), 0.01);
}

TEST_F(ResultFiles, TellOccludedTracksWhereTheColumnIsPresent) {
  const std::string header =
      "timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class";
  const std::string row = "0.1,7,1,2,0,10,0,4.5,1.8,moving,1,car";
  write(folder_ / "tracks.csv", header + ",occluded\n" + row + ",1\n" + row + ",0\n");
  const auto result = read_result(folder_.path());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->tracks[0].tracks[0].is_occluded);
  EXPECT_FALSE(result->tracks[0].tracks[1].is_occluded);
  write(folder_ / "tracks.csv", header + "\n" + row + "\n");
  EXPECT_FALSE(read_result(folder_.path())->tracks[0].tracks[0].is_occluded);
}

TEST_F(ResultFiles, JoinTracksWithTheirPredictions) {
  write(folder_ / "tracks.csv", tracks_csv(0.0, 0.0));
  write(folder_ / "predictions.csv",
        "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n0.100000,7,1.0,20,1,0.04,0.01,0.09\n0."
        "100000,7,2.0,30,2,0.4,0.1,0.9\n");
  const auto result = read_result(folder_.path());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->tracks[0].tracks[0].predicted_in_map.empty());
  const auto& predicted = result->tracks[1].tracks[0].predicted_in_map;
  ASSERT_EQ(predicted.size(), 2U);
  EXPECT_EQ(predicted[1].after_s, 2.0);
  EXPECT_EQ(predicted[1].position_m.y(), 2.0);
  EXPECT_EQ(predicted[1].covariance_m2(1, 0), 0.1);
}

TEST_F(ResultFiles, RejectAPredictionWithoutHorizon) {
  write(folder_ / "tracks.csv", tracks_csv(0.0, 0.0));
  write(folder_ / "predictions.csv",
        "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n0.100000,7,8e9,20,1,0.04,0.01,0.09\n");
  const auto result = read_result(folder_.path());
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("not a valid horizon"));
}

TEST_F(ResultFiles, ReadTheMapAsItIsWritten) {
  const files::MapImage image{3, 2, 0.2, -1.0, 4.0, {0, 205, 254, 254, 205, 0}};
  write(folder_ / "map.pgm", files::to_pgm(image));
  write(folder_ / "map.yaml", files::to_map_server_yaml(image, "map.pgm"));
  const auto map = read_map(folder_ / "map.yaml");
  ASSERT_TRUE(map);
  EXPECT_EQ(map->pixels, image.pixels);
  EXPECT_EQ(map->width, 3U);
  EXPECT_DOUBLE_EQ(map->min_x_m, -1.0);
  EXPECT_DOUBLE_EQ(map->min_y_m, 4.0);
  EXPECT_DOUBLE_EQ(map->resolution_m, 0.2);
}

TEST_F(ResultFiles, OfMergedMapsNeedNoDrive) {
  EXPECT_THAT(read_map_folder(folder_.path()).error().message, HasSubstr("map.yaml: no such file"));
  write(folder_ / "map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [1, 2, 0]\n");
  write(folder_ / "map.pgm", "P5\n2 1\n255\n" + std::string(2, '\0'));
  const auto result = read_map_folder(folder_.path());
  ASSERT_TRUE(result);
  EXPECT_TRUE(result->corrected.empty());
  const GroundView view = whole_view(*result, 100.0);
  EXPECT_EQ(view.width, 100.0);
}

TEST_F(ResultFiles, ReportATruncatedFile) {
  const files::MapImage image{3, 2, 0.2, -1.0, 4.0, {0, 205, 254, 254, 205, 0}};
  const std::string pgm = files::to_pgm(image);
  write(folder_ / "map.pgm", pgm.substr(0, pgm.size() - 1));
  write(folder_ / "map.yaml", files::to_map_server_yaml(image, "map.pgm"));
  const auto map = read_map(folder_ / "map.yaml");
  ASSERT_FALSE(map);
  EXPECT_THAT(map.error().message, HasSubstr("cut off"));
}

TEST_F(ResultFiles, ReportAFolderWithoutResult) {
  testing::TemporaryFolder empty;
  const auto result = read_result(empty.path());
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("online.tum: no such file"));
}

}  // namespace
}  // namespace slammot::evaluator
