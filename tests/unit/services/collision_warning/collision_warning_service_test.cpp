#include "services/collision_warning/collision_warning_service.hpp"

#include <gtest/gtest.h>

#include "common/wire/tracked_objects.hpp"
#include "tests/support/service_on_the_bus.hpp"
#include "tests/unit/services/collision_warning/situation.hpp"

namespace slammot::collision_warning {
namespace {

using slammot::testing::kForever;

struct CollisionWarningOnTheBus : slammot::testing::ServiceOnTheBus {
  dds::Writer<slammot_TrackedObjects> tracks{neighbour_, dds::topics::kTrackedObjects};
  dds::Reader<slammot_CollisionWarnings> warnings{neighbour_, dds::topics::kCollisionWarnings};
  wire::TrackedObjectsEncoder encoder;
  std::vector<flow::CollisionWarnings> received;

  void begin() {
    start<CollisionWarningService>("collision_warning");
    ASSERT_TRUE(tracks.wait_for_readers(1, kForever));
    ASSERT_TRUE(warnings.wait_for_writers(1, kForever));
  }
  bool has_answered(std::size_t count) {
    warnings.take_each([this](const slammot_CollisionWarnings& sample) {
      const auto decoded = wire::decode(sample);
      EXPECT_TRUE(decoded) << decoded.fault();
      if (decoded) received.push_back(*decoded);
    });
    return received.size() >= count;
  }
};

TEST_F(CollisionWarningOnTheBus, PublishesWhatTheMonitorComputes) {
  begin();
  CollisionMonitor monitor{CollisionWarningConfig{}};
  std::vector<flow::CollisionWarnings> expected;
  for (int i = 0; i < 20; ++i) {
    const flow::TrackedObjects tracked = tracked_at(0.05 * i, 8.0, {{20.0, 0.0}, {0.0, 0.0}});
    expected.push_back(monitor.step(tracked));
    tracks.write(encoder.encode("car", tracked));
    ASSERT_TRUE(comes_to([&] { return has_answered(expected.size()); }));
  }
  EXPECT_EQ(received.back().highest_level, flow::WarningLevel::kWarning);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(received[i].stamp_ns, expected[i].stamp_ns);
    EXPECT_EQ(received[i].highest_level, expected[i].highest_level);
    ASSERT_EQ(received[i].objects.size(), 1U);
    EXPECT_EQ(received[i].objects[0].probability, expected[i].objects[0].probability);
    EXPECT_EQ(received[i].objects[0].time_to_collision_s,
              expected[i].objects[0].time_to_collision_s);
  }
  EXPECT_EQ(context_->status().counter("warnings"), 1U);
}

TEST_F(CollisionWarningOnTheBus, DropsAndCountsFaultyTracks) {
  begin();
  flow::TrackedObjects faulty = tracked_at(0.0, 8.0, {{20.0, 0.0}, {0.0, 0.0}});
  faulty.objects.front().length_m = -1.0;
  tracks.write(encoder.encode("car", faulty));
  ASSERT_TRUE(comes_to([&] { return context_->status().counter("faulty_tracks") == 1; }));
  tracks.write(encoder.encode("car", tracked_at(0.1, 8.0, {{20.0, 0.0}, {0.0, 0.0}})));
  EXPECT_TRUE(comes_to([&] { return has_answered(1); }));
}

TEST_F(CollisionWarningOnTheBus, AnswersWhereNobodyIsTracked) {
  begin();
  flow::TrackedObjects nobody = tracked_at(0.0, 8.0, {{20.0, 0.0}, {0.0, 0.0}});
  nobody.objects.clear();
  tracks.write(encoder.encode("car", nobody));
  ASSERT_TRUE(comes_to([&] { return has_answered(1); }));
  EXPECT_TRUE(received[0].objects.empty());
}

}  // namespace
}  // namespace slammot::collision_warning
