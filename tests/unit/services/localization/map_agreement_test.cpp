#include "services/localization/map_agreement.hpp"

#include <gtest/gtest.h>

#include "tests/support/mapped_world.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using slammot::testing::MappedWorld;

/// Of a scan in the room at the truth that is held to be at another pose.
MapAgreement agreement_at(const Pose2& believed, const Pose2& truth = {}) {
  const MappedWorld room(slammot::testing::room());
  return agreement(room.points_at(truth), believed, room.map().evidence(), room.config().map);
}

TEST(MapAgreement, IsFullWhereTheScanWasMade) {
  const MapAgreement found = agreement_at({});
  EXPECT_GT(found.explained, 60);
  EXPECT_LT(found.contradicting_share(), 0.05);
}

TEST(MapAgreement, IsContradictedInAnotherPlace) {
  const MapAgreement found = agreement_at({2.5, 1.0, 0.6});
  EXPECT_GT(found.contradicting_share(), 0.5);
  EXPECT_GT(found.share_behind_walls(), 0.1);
}

TEST(MapAgreement, SaysNothingOfWhatTheMapHasNotSeen) {
  EXPECT_EQ(agreement_at({500.0, 0.0, 0.0}).contradicting_share(), 0.0);
}

TEST(ExplainedShare, FallsWithTheDistanceFromTheTruth) {
  const MappedWorld room(slammot::testing::room());
  const ScanPoints points = room.points_at({});
  const auto share_at = [&](const Pose2& pose) {
    return explained_share(points.matched(), pose, room.map().evidence(), room.config().map);
  };
  EXPECT_GT(share_at({}), 0.95);
  EXPECT_LT(share_at({2.5, 1.0, 0.6}), 0.5);
  EXPECT_EQ(explained_share({}, {}, room.map().evidence(), room.config().map), 0.0);
}

}  // namespace
}  // namespace slammot::localization
