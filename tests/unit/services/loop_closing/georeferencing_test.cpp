#include "services/loop_closing/georeferencing.hpp"

#include <gtest/gtest.h>

#include "common/flow/georeference_verdict.hpp"
#include "common/simulation/random.hpp"

namespace slammot::loop_closing {
namespace {

using geometry::Geodetic;
using geometry::Pose2;
using geometry::Vector2;

constexpr double kSigma_m = 1.2;
const Geodetic kWorld{40.4406, -79.9959};
const Pose2 kWorldFromMap{30.0, 50.0, 0.4};

/// An L-shaped drive with a submap each 60 m.
struct GeoreferencingTest : ::testing::Test {
  GeoreferencingTest() {
    for (std::uint32_t i = 0; i < 12; ++i) {
      const Pose2 map_from_submap =
          i < 6 ? Pose2{60.0 * i, 0.0, 0.0} : Pose2{300.0, 60.0 * (i - 5.0), 1.5708};
      submaps.push_back({{i}, map_from_submap});
      georeferencing.add(submap(i));
    }
  }

  flow::Submap submap(std::uint32_t id) {
    flow::Submap made;
    made.submap_id = {id};
    for (int i = 0; i < 20; ++i) {
      const Vector2 in_submap_m{3.0 * i, 0.0};
      const Vector2 error_m{kSigma_m * random.normal(), kSigma_m * random.normal()};
      const Vector2 in_world_m =
          kWorldFromMap * (submaps[id].map_from_submap * in_submap_m) + error_m + multipath_m(id);
      const auto variance = static_cast<float>(kSigma_m * kSigma_m);
      made.fixes.push_back({static_cast<float>(in_submap_m.x()), 0.0F,
                            geometry::geodetic_at(kWorld, in_world_m), variance, variance, 0.0F});
    }
    return made;
  }

  /// Lasts for 120 m.
  static Vector2 multipath_m(std::uint32_t id) {
    return id == 3 || id == 4 ? Vector2(-35.0, 20.0) : Vector2::Zero();
  }

  std::optional<Georeferencing::Result> compare() const {
    return georeferencing.compare(submaps, [&] {
      std::vector<flow::Constraint> constraints;
      for (std::size_t i = 1; i < submaps.size(); ++i)
        constraints.push_back(
            {submaps[i - 1].submap_id,
             submaps[i].submap_id,
             flow::ConstraintKind::kOdometric,
             {geometry::inverse(submaps[i - 1].map_from_submap) * submaps[i].map_from_submap,
              Eigen::Vector3d(0.01, 0.01, 1e-5).asDiagonal()}});
      return constraints;
    });
  }

  simulation::Random random{3, simulation::Purpose::gnss};
  std::vector<flow::CorrectedSubmap> submaps;
  Georeferencing georeferencing;
};

TEST_F(GeoreferencingTest, FindsTheMapOnTheEarthInSpiteOfMultipath) {
  const auto found = compare();
  ASSERT_TRUE(found && found->georeference.has_position);
  const Vector2 origin_m = geometry::east_north_m(kWorld, found->georeference.origin);
  EXPECT_NEAR(origin_m.x(), kWorldFromMap.x_m, 1.5);
  EXPECT_NEAR(origin_m.y(), kWorldFromMap.y_m, 1.5);
  EXPECT_NEAR(found->georeference.x_from_east_rad, kWorldFromMap.heading_rad, 0.01);
  EXPECT_EQ(found->georeference.fixes, 240U);
  EXPECT_GE(found->georeference.rejected_fixes, 40U);
  EXPECT_LE(found->georeference.rejected_fixes, 50U);
}

TEST_F(GeoreferencingTest, LeavesAMapThatIsRightAsItIs) {
  const auto found = compare();
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->georeference.corrects_map);
  for (std::size_t i = 0; i < submaps.size(); ++i)
    EXPECT_EQ(found->submaps[i].map_from_submap, submaps[i].map_from_submap);
}

TEST_F(GeoreferencingTest, DoesNotUseFixesThatJumpInTheMiddleOfTheDrive) {
  Georeferencing jumping;
  for (std::uint32_t id = 0; id < submaps.size(); ++id) {
    flow::Submap made = submap(id);
    if (id >= 6) {
      for (flow::SubmapFix& fix : made.fixes) fix.position.latitude_deg += 1.0 / 60.0;
    }
    jumping.add(made);
  }
  const auto found = jumping.compare(submaps, [] { return std::vector<flow::Constraint>(); });
  ASSERT_TRUE(found);
  EXPECT_TRUE(flow::gnss_contradicts_map(found->georeference));
  EXPECT_FALSE(found->georeference.has_position);
  EXPECT_FALSE(found->georeference.has_direction);
  EXPECT_GT(found->georeference.fix_sigma_m, 100.0);
}

TEST_F(GeoreferencingTest, KeepsThePlaceButNotACompassThatIsTurned) {
  for (const flow::CorrectedSubmap& at : submaps) {
    flow::Submap made;
    made.submap_id = at.submap_id;
    const double true_rad = kWorldFromMap.heading_rad + at.map_from_submap.heading_rad;
    for (int i = 0; i < 20; ++i)
      made.headings.push_back(
          {0.0F, static_cast<float>(geometry::wrap_angle(true_rad - 1.5)), 0.05F});
    georeferencing.add(made);
  }
  const auto found = compare();
  ASSERT_TRUE(found);
  EXPECT_TRUE(flow::compass_contradicts_gnss(found->georeference));
  EXPECT_TRUE(found->georeference.has_position);
  EXPECT_NEAR(found->georeference.compass_bias_rad, -1.5, 0.05);
  EXPECT_NEAR(found->georeference.x_from_east_rad, kWorldFromMap.heading_rad, 0.01);
}

TEST_F(GeoreferencingTest, SaysNothingWithoutMeasurements) {
  EXPECT_FALSE(Georeferencing().compare(submaps, [] { return std::vector<flow::Constraint>(); }));
}

}  // namespace
}  // namespace slammot::loop_closing
