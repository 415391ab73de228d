#include "services/evaluator/truth_files.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::HasSubstr;
using testing::PoseNear;

class TruthFiles : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
};

TEST_F(TruthFiles, AreATrajectoryObjectsAndWalls) {
  write(folder_ / "drive.tum", straight_tum(5.0));
  write(folder_ / "drive.objects.csv", car_ahead_csv(5.0));
  write(folder_ / "drive.walls.csv", "ax,ay,bx,by,class\n0,1,2,3,0\n");
  const auto truth = read_truth(folder_ / "drive");
  ASSERT_TRUE(truth);
  EXPECT_EQ(truth->trajectory.size(), 301U);
  ASSERT_TRUE(truth->objects);
  EXPECT_EQ(truth->objects->size(), 301U);
  EXPECT_EQ(truth->object_count, 1U);
  ASSERT_TRUE(truth->walls);
  EXPECT_EQ(truth->walls->front().to_m, geometry::Vector2(2.0, 3.0));
}

TEST_F(TruthFiles, SeparateHiddenObjects) {
  write(folder_ / "drive.tum", straight_tum(5.0));
  write(folder_ / "drive.objects.csv",
        "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n"
        "1.0,17,car,1,0,0,2,4,2,3,5\n1.0,18,car,9,0,0,2,4,2,0,5\n");
  const auto truth = read_truth(folder_ / "drive");
  ASSERT_TRUE(truth);
  ASSERT_EQ(truth->objects->front().objects.size(), 1U);
  ASSERT_EQ(truth->objects->front().hidden.size(), 1U);
  EXPECT_EQ(truth->objects->front().hidden.front().world_from_object.x_m, 9.0);
}

TEST_F(TruthFiles, ReadTheHitsOfBeams) {
  write(folder_ / "drive.tum", straight_tum(5.0));
  write(folder_ / "drive.objects.csv",
        "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n1.0,17,car,1,0,0,2,4,2,3,5\n");
  write(folder_ / "drive.hits.csv",
        "timestamp,scanner,hits\n1.0,front,0*2 17*3 -1*1 -2*1\n1.0,rear,0*9\n");
  const auto truth = read_truth(folder_ / "drive");
  ASSERT_TRUE(truth) << truth.error().message;
  ASSERT_EQ(truth->hits->size(), 1U);  // of the first scanner
  const auto hits = truth->hits->front().hits();
  ASSERT_EQ(hits.size(), 7U);
  using On = metrics::BeamHit::On;
  EXPECT_EQ(hits[1].on, On::kStationary);
  EXPECT_EQ(hits[4].on, On::kObject);
  EXPECT_EQ(hits[4].object, truth->objects->front().objects.front().object);
  EXPECT_EQ(hits[5].on, On::kNothing);
  EXPECT_EQ(hits[6].on, On::kSeveral);
}

TEST_F(TruthFiles, RejectInvalidHits) {
  write(folder_ / "drive.tum", straight_tum(5.0));
  write(folder_ / "drive.objects.csv",
        "timestamp,id,class,x,y,yaw,speed,length,width,points,range\n1.0,17,car,1,0,0,2,4,2,3,5\n");
  for (const char* hits : {"0", "0*", "*3", "0*0", "18*2", "0*99999999999", "0*2  17*1"}) {
    write(folder_ / "drive.hits.csv",
          std::string("timestamp,scanner,hits\n1.0,front,") + hits + "\n");
    const auto truth = read_truth(folder_ / "drive");
    ASSERT_FALSE(truth) << hits;
    EXPECT_THAT(truth.error().message, HasSubstr("drive.hits.csv:2"));
  }
}

TEST_F(TruthFiles, MayBeATrajectoryOnly) {
  write(folder_ / "drive.tum", straight_tum(5.0));
  const auto truth = read_truth(folder_ / "drive");
  ASSERT_TRUE(truth);
  EXPECT_FALSE(truth->objects);
  EXPECT_FALSE(truth->walls);
}

TEST_F(TruthFiles, ReadCarmenReferences) {
  write(folder_ / "log.reference.txt",
        "# index stamp x y theta\n0 21.0 1.5 -2 0.5\n1 22.0 2 -2 0.6\n");
  const auto truth = read_truth(folder_ / "log");
  ASSERT_TRUE(truth);
  EXPECT_THAT(truth->trajectory[0].pose, PoseNear(geometry::Pose2{1.5, -2.0, 0.5}, 1e-12));
}

TEST_F(TruthFiles, ReadMotionCaptureOfTwoCars) {
  write(folder_ / "log.ego.tum", straight_tum(0.0));
  write(folder_ / "log.red.tum", straight_tum(3.0));
  const auto truth = read_truth(folder_ / "log");
  ASSERT_TRUE(truth);
  ASSERT_TRUE(truth->other_car);
  EXPECT_EQ(truth->other_car->front().pose.x_m, 3.0);
}

TEST_F(TruthFiles, ReportMissingFiles) {
  const auto truth = read_truth(folder_ / "nothing");
  ASSERT_FALSE(truth);
  EXPECT_THAT(truth.error().message, HasSubstr("no truth here"));
}

TEST_F(TruthFiles, NameTheFirstMalformedRow) {
  write(folder_ / "drive.tum", "1.0 0 0 0 0 0 0 1\n2.0 0 0\n");
  const auto truth = read_truth(folder_ / "drive");
  ASSERT_FALSE(truth);
  EXPECT_THAT(truth.error().message, HasSubstr("drive.tum:2: 3 fields where 8 are needed"));
}

}  // namespace
}  // namespace slammot::evaluator
