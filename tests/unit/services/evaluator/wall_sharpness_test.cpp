#include "services/evaluator/wall_sharpness.hpp"

#include <cstdio>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/synthetic_world.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using geometry::Pose2;
using metrics::PosePair;

constexpr int kScans = 60;
constexpr std::size_t kBeams = 181;

double time_s(int scan) { return 0.1 * scan; }

std::int64_t stamp_ns(int scan) { return std::int64_t{100'000'000} * scan + 50'000'000'000; }

/// A robot that drives a loop in a room: log and true poses.
class WallSharpnessOfARoom : public ::testing::Test {
 protected:
  WallSharpnessOfARoom() {
    const auto path = slammot::testing::arc({0.0, -3.0, 0.0}, 0.5, 0.2);
    std::mt19937 random(11);
    std::string log;
    for (int scan = 0; scan < kScans; ++scan) {
      const auto ranges = slammot::testing::scan_along(slammot::testing::room(), path, time_s(scan),
                                                       scanner(), kBeams, 0.005, random)
                              .range_m;
      log += "FLASER " + std::to_string(kBeams);
      for (const float range_m : ranges) log += " " + std::to_string(range_m);
      char rest[128];
      const Pose2 pose = path(time_s(scan));
      std::snprintf(rest, sizeof rest, " %f %f %f %f %f %f %f host %f\n", pose.x_m, pose.y_m,
                    pose.heading_rad, pose.x_m, pose.y_m, pose.heading_rad,
                    1e-9 * static_cast<double>(stamp_ns(scan)), time_s(scan));
      log += rest;
      pairs_.push_back({stamp_ns(scan), pose, pose});
    }
    write(file(), log);
  }

  static sensing::Scanner scanner() { return slammot::testing::half_circle_scanner(); }
  std::filesystem::path file() const { return folder_ / "room.log"; }
  WallSharpness of(const std::vector<PosePair>& pairs) const {
    return *wall_sharpness(file(), pairs, 0.0, {.cell_size_m = 0.05});
  }

  testing::TemporaryFolder folder_;
  std::vector<PosePair> pairs_;
};

TEST_F(WallSharpnessOfARoom, IsEqualAtEqualPoses) {
  const WallSharpness walls = of(pairs_);
  EXPECT_EQ(walls.scans, static_cast<std::size_t>(kScans));
  EXPECT_GT(walls.of_truth.occupied_cells, 300U);
  EXPECT_EQ(walls.of_estimate.entropy_bits, walls.of_truth.entropy_bits);
}

TEST_F(WallSharpnessOfARoom, IsLowerAtPosesWithErrors) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (PosePair& pair : pairs_)
    pair.estimate =
        pair.truth * Pose2{0.05 * normal(random), 0.05 * normal(random), 0.01 * normal(random)};
  const WallSharpness walls = of(pairs_);
  EXPECT_GT(walls.of_estimate.mean_entropy_bits(), 1.1 * walls.of_truth.mean_entropy_bits());
}

TEST_F(WallSharpnessOfARoom, UsesOnlyScansWithBothPoses) {
  pairs_.erase(pairs_.begin() + 10, pairs_.begin() + 30);
  pairs_.push_back({stamp_ns(kScans + 5), {}, {}});
  EXPECT_EQ(of(pairs_).scans, static_cast<std::size_t>(kScans - 20));
}

TEST_F(WallSharpnessOfARoom, LeavesOutDistantEchoes) {
  const auto near =
      wall_sharpness(file(), pairs_, 0.0, {.cell_size_m = 0.05, .longest_range_m = 2.0});
  EXPECT_LT(near->of_truth.touched_cells, of(pairs_).of_truth.touched_cells);
}

TEST_F(WallSharpnessOfARoom, ReportsFaultsOfTheLog) {
  EXPECT_FALSE(wall_sharpness(folder_ / "none.log", pairs_, 0.0, {.cell_size_m = 0.05}));
}

}  // namespace
}  // namespace slammot::evaluator
