#include "services/evaluator/evaluation.hpp"

#include <cmath>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;

/// A car ahead with a track 0.5 m beside its box; the map begins at x = 100 m in world.
class Evaluate : public ::testing::Test {
 protected:
  void SetUp() override {
    write(folder_ / "online.tum", straight_tum(0.0));
    write(folder_ / "trajectory.tum", straight_tum(0.0));
    write(folder_ / "tracks.csv", tracks_csv(0.0, 1.4));
    write(folder_ / "drive.tum", straight_tum(100.0));
    write(folder_ / "drive.objects.csv", car_ahead_csv(100.0));
  }

  files::Result<Evaluation> evaluated() {
    const auto truth = read_truth(folder_ / "drive");
    const auto result = read_result(folder_.path());
    if (!truth) return truth.error();
    if (!result) return result.error();
    return evaluate(*result, *truth, {}, {});
  }

  testing::TemporaryFolder folder_;
};

TEST_F(Evaluate, JoinsMapAndWorldByTheVehicle) {
  const auto evaluation = evaluated();
  ASSERT_TRUE(evaluation);
  EXPECT_NEAR(evaluation->corrected.absolute_m.rmse, 0.0, 1e-9);
  ASSERT_TRUE(evaluation->tracking);
  EXPECT_DOUBLE_EQ(evaluation->tracking->clear.mota, 1.0);
  EXPECT_NEAR(evaluation->tracking->clear.motp, 1.0 - 0.5 / 4.0, 1e-9);
  EXPECT_NEAR(evaluation->tracking->errors.all.centre_m.rmse, 1.4, 1e-9);
  EXPECT_NEAR(evaluation->tracking->errors.all.velocity_mps.rmse, 0.0, 1e-9);
  EXPECT_NEAR(evaluation->tracking->gospa.localization_m2, 0.25, 1e-9);
}

/// The lines with another ending: `before` up to the first line that begins with `mark`, `after`
/// from there on.
std::string with_ending(const std::string& csv, const std::string& mark, const std::string& ending,
                        const std::string& before, const std::string& after) {
  std::string text;
  bool is_after = false;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    is_after = is_after || line.starts_with(mark);
    if (line.ends_with(ending))
      line.replace(line.size() - ending.size(), ending.size(), is_after ? after : before);
    text += line + "\n";
  }
  return text;
}

TEST_F(Evaluate, LeavesHiddenObjectsAndOccludedTracksToTheFiguresOfOcclusion) {
  std::string tracks = with_ending(tracks_csv(0.0, 0.0), "25.0", ",car", ",car,0", ",car,1");
  tracks.insert(tracks.find('\n'), ",occluded");
  write(folder_ / "tracks.csv", tracks);
  write(folder_ / "drive.objects.csv",
        with_ending(car_ahead_csv(100.0), "25.0", ",20,10", ",20,10", ",0,10"));
  const auto evaluation = evaluated();
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->tracking->clear.true_positives, 250U);
  EXPECT_EQ(evaluation->tracking->clear.false_positives, 0U);
  EXPECT_EQ(evaluation->tracking->clear.misses, 0U);
  ASSERT_TRUE(evaluation->occlusion);
  EXPECT_EQ(evaluation->occlusion->published.occluded.at_own_object, 51U);
  EXPECT_EQ(evaluation->occlusion->position_m.count, 51U);
}

TEST_F(Evaluate, RejectsAnotherClock) {
  write(folder_ / "drive.tum", straight_tum(100.0, 5000.0));
  const auto evaluation = evaluated();
  ASSERT_FALSE(evaluation);
  EXPECT_THAT(evaluation.error().message, HasSubstr("the clocks do not overlap"));
}

TEST_F(Evaluate, EvaluatesOnlyTheTrajectoryWhereTheMotionDiffers) {
  std::string circle;
  for (int i = 0; i <= 300; ++i) {
    const double turn = 0.1 * i;  // radius of 10 m
    circle += std::to_string(0.1 * i) + " " + std::to_string(10.0 * std::sin(turn)) + " " +
              std::to_string(-10.0 * std::cos(turn)) + " 0 0 0 " +
              std::to_string(std::sin(0.5 * turn)) + " " + std::to_string(std::cos(0.5 * turn)) +
              "\n";
  }
  write(folder_ / "drive.tum", circle);
  const auto evaluation = evaluated();
  ASSERT_TRUE(evaluation);
  EXPECT_TRUE(evaluation->motion_differs);
  EXPECT_THAT(evaluation->notes, ElementsAre(HasSubstr("the estimate is wrong, or the truth is")));
  EXPECT_GT(evaluation->corrected.absolute_m.rmse, 5.0);
  EXPECT_FALSE(evaluation->tracking);
}

TEST_F(Evaluate, RejectsObjectsOfAnotherFrame) {
  write(folder_ / "drive.objects.csv", car_ahead_csv(90000.0));
  const auto evaluation = evaluated();
  ASSERT_FALSE(evaluation);
  EXPECT_THAT(evaluation.error().message, HasSubstr("the nearest true object is"));
}

TEST_F(Evaluate, RejectsObjectsOfAnotherClock) {
  write(folder_ / "drive.objects.csv",
        "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n900.0,1,car,110,0,0,10,4.5,1."
        "8,20,10\n");
  const auto evaluation = evaluated();
  ASSERT_FALSE(evaluation);
  EXPECT_THAT(evaluation.error().message,
              HasSubstr("no scan of the result has true objects at its time"));
}

TEST_F(Evaluate, NotesThePartsThatItLeavesOut) {
  std::filesystem::remove(folder_ / "drive.objects.csv");
  const auto evaluation = evaluated();
  ASSERT_TRUE(evaluation);
  EXPECT_FALSE(evaluation->tracking);
  EXPECT_THAT(evaluation->notes, ::testing::Contains(HasSubstr("no true objects")));
}

TEST_F(Evaluate, EvaluatesTheOtherCarOfMotionCapture) {
  for (const char* file : {"drive.tum", "drive.objects.csv"})
    std::filesystem::remove(folder_ / file);
  write(folder_ / "drive.ego.tum", straight_tum(100.0));
  write(folder_ / "drive.red.tum", straight_tum(110.0));
  write(folder_ / "tracks.csv", tracks_csv(0.0, 0.1));
  const auto evaluation = evaluated();
  ASSERT_TRUE(evaluation);
  ASSERT_TRUE(evaluation->other_car);
  EXPECT_EQ(evaluation->other_car->matched_scans, evaluation->other_car->scans);
  EXPECT_EQ(evaluation->other_car->identities, 1U);
  EXPECT_NEAR(evaluation->other_car->position_m.rmse, 0.1, 1e-9);
  EXPECT_NEAR(evaluation->other_car->velocity_mps.rmse, 0.0, 1e-6);
  EXPECT_EQ(evaluation->other_car->false_moving_tracks_a_scan, 0.0);
}

}  // namespace
}  // namespace slammot::evaluator
