#include "services/slammot/replay_comparison.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "services/slammot/replay_plan.hpp"
#include "services/slammot/replay_text.hpp"

namespace slammot {
namespace {

const std::string kTopic = "slammot/test";

dds::TypeModel model() {
  dds::NamedType type;
  type.kind = dds::NamedType::Kind::kStruct;
  type.name = "test::Sample";
  type.members = {{"stamp_ns", {dds::TypeKind::kInt64}},
                  {"speed_mps", {dds::TypeKind::kFloat64}},
                  {"shares", {dds::TypeKind::kSequence, {}, 0, {}, {{dds::TypeKind::kFloat64}}}}};
  return {{type}};
}

/// Version 1 of CDR, little endian.
std::vector<std::uint8_t> sample(std::int64_t stamp_ns, double speed_mps,
                                 const std::vector<double>& shares) {
  std::vector<std::uint8_t> bytes = {0, 1, 0, 0};
  const auto append = [&](const auto& value) {
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), raw, raw + sizeof value);
  };
  append(stamp_ns);
  append(speed_mps);
  append(static_cast<std::uint32_t>(shares.size()));
  append(std::uint32_t{0});  // to a multiple of 8
  for (const double share : shares) append(share);
  return bytes;
}

class ReplayedSamples : public ::testing::Test {
 protected:
  void compare(const std::vector<std::uint8_t>& recorded,
               const std::vector<std::uint8_t>& replayed) {
    comparison_.compare({&kTopic, &model_, 5, 1.5, recorded}, replayed);
  }
  const TopicDifferences& topic() const { return comparison_.topics().at(kTopic); }

  dds::TypeModel model_ = model();
  ReplayComparison comparison_{ReplayTolerances{.general = 1e-6, .of_field = {{"shares[]", 0.1}}}};
};

TEST_F(ReplayedSamples, AreEqualWithinTheTolerances) {
  compare(sample(5, 20.0, {0.5}), sample(5, 20.0, {0.5}));
  compare(sample(5, 20.0, {0.5}), sample(5, 20.00001, {0.55}));
  compare(sample(5, std::nan(""), {}), sample(5, -std::nan(""), {}));
  EXPECT_FALSE(comparison_.has_difference());
  EXPECT_EQ(topic().compared, 3U);
  EXPECT_EQ(describe(comparison_), "slammot/test: 3 samples compared, 0 differ\nno difference\n");
}

TEST_F(ReplayedSamples, NameTheFirstFieldThatDiffersAndTheGreatestDistanceOfEach) {
  compare(sample(5, 20.0, {0.5, 0.5}), sample(5, 20.0, {0.5, 0.8}));
  compare(sample(6, 20.0, {0.5}), sample(6, 21.0, {0.0}));
  ASSERT_TRUE(comparison_.first());
  EXPECT_EQ(comparison_.first()->field, "shares[1]");
  EXPECT_EQ(comparison_.first()->stamp_ns, 5);
  EXPECT_EQ(topic().different, 2U);
  EXPECT_EQ(topic().fields.at("shares[]").values, 2U);
  EXPECT_NEAR(topic().fields.at("shares[]").largest, 0.5, 1e-12);
  EXPECT_NEAR(topic().fields.at("speed_mps").largest, 1.0, 1e-12);
  EXPECT_NE(describe(comparison_).find("stamp 5 ns, 1.500 s into the recording, shares[1]"),
            std::string::npos);
}

TEST_F(ReplayedSamples, OfOtherLengthDifferInTheLength) {
  compare(sample(5, 20.0, {0.5}), sample(5, 20.0, {0.5, 0.5}));
  EXPECT_EQ(comparison_.first()->field, "shares.length");
  EXPECT_EQ(topic().fields.size(), 1U);
}

TEST_F(ReplayedSamples, ThatDoNotComeAreMissing) {
  comparison_.note_missing({&kTopic, &model_, 5, 1.5, {}});
  comparison_.note_additional({&kTopic, &model_, 6, 0.0, {}});
  EXPECT_TRUE(comparison_.has_difference());
  EXPECT_EQ(topic().missing, 1U);
  EXPECT_EQ(topic().additional, 1U);
}

TEST(ReplayPlan, KnowsServicesByBothSpellings) {
  const auto plan = replay_plan("loop-closing");
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->service, "loop_closing");
  EXPECT_TRUE(plan->is_input(plan->trigger));
  EXPECT_TRUE(plan->is_output("slammot/graph_correction"));
  EXPECT_FALSE(replay_plan("gateway"));
}

}  // namespace
}  // namespace slammot
