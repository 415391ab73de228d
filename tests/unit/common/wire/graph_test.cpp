#include "common/wire/graph.hpp"

#include <algorithm>
#include <memory>

#include <gtest/gtest.h>

#include "tests/support/matchers.hpp"
#include "tests/support/values.hpp"

namespace slammot::wire {
namespace {

using slammot::testing::kNan;

TEST(ConstraintOnTheWire, ComesBackAsItWas) {
  testing::Random random(1);
  const flow::Constraint constraint{{3},
                                    {9},
                                    flow::ConstraintKind::kLoop,
                                    testing::uncertain_pose(random),
                                    {17},
                                    {flow::ClosureState::kWithdrawn, 21.5, 0.75, "outweighed"}};
  const auto back = decode(encode("car", constraint));
  ASSERT_TRUE(back) << back.fault();
  EXPECT_EQ(back->map_id, constraint.map_id);
  EXPECT_EQ(back->from, constraint.from);
  EXPECT_EQ(back->to, constraint.to);
  EXPECT_EQ(back->kind, constraint.kind);
  EXPECT_EQ(back->from_to.pose, constraint.from_to.pose);
  EXPECT_EQ(back->from_to.covariance, constraint.from_to.covariance);
  EXPECT_EQ(back->verdict.state, constraint.verdict.state);
  EXPECT_EQ(back->verdict.squared_error, constraint.verdict.squared_error);
  EXPECT_EQ(back->verdict.agreed_share, constraint.verdict.agreed_share);
  EXPECT_EQ(back->verdict.reason, constraint.verdict.reason);
}

TEST(ConstraintOnTheWire, IsRefusedWhereItIsUnsound) {
  const auto fault_after = [](auto corrupt) {
    slammot_Constraint sample =
        encode("car", flow::Constraint{{3}, {9}, flow::ConstraintKind::kOdometric, {}});
    corrupt(sample);
    return decode(sample).fault();
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.kind = static_cast<slammot_ConstraintKind>(2); }), "");
  EXPECT_NE(fault_after([](auto& s) { s.state = static_cast<slammot_ClosureState>(3); }), "");
  EXPECT_NE(fault_after([](auto& s) { s.squared_error = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.to_submap_id = s.from_submap_id; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.from_from_to.mean.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.from_from_to.covariance[0] = -1.0; }), "");
}

struct KeptPart {
  explicit KeptPart(const slammot_GraphCorrection& part)
      : submaps(part.submaps._buffer, part.submaps._buffer + part.submaps._length),
        georeferences(part.georeference._buffer,
                      part.georeference._buffer + part.georeference._length),
        sample(part) {}

  slammot_GraphCorrection& shown() {
    sample.submaps._buffer = submaps.data();
    sample.georeference._buffer = georeferences.data();
    return sample;
  }

  std::vector<slammot_CorrectedSubmap> submaps;
  std::vector<slammot_Georeference> georeferences;
  slammot_GraphCorrection sample;
};

struct GraphCorrectionInParts : ::testing::Test {
  testing::Random random{1};
  GraphCorrectionAssembler assembler;

  flow::GraphCorrection correction(std::uint32_t sequence, std::uint32_t submaps) {
    flow::GraphCorrection made{sequence, testing::pose(random), {}, {17}, true, georeference()};
    for (std::uint32_t id = 0; id < submaps; ++id)
      made.submaps.push_back({{id}, testing::pose(random)});
    return made;
  }

  static flow::Georeference georeference() {
    flow::Georeference place;
    place.has_position = place.has_direction = true;
    place.origin = {40.5, -79.5};
    place.x_from_east_rad = 0.75;
    place.position_sigma_m = 1.5;
    place.fixes = 812;
    place.rejected_fixes = 73;
    return place;
  }

  static std::vector<KeptPart> parts_of(const flow::GraphCorrection& whole) {
    std::vector<KeptPart> parts;
    GraphCorrectionEncoder().encode(
        "car", whole, [&](const slammot_GraphCorrection& part) { parts.emplace_back(part); });
    return parts;
  }

  std::optional<flow::GraphCorrection> assemble(std::vector<KeptPart>& parts) {
    std::optional<flow::GraphCorrection> result;
    for (KeptPart& part : parts) {
      auto added = assembler.add(part.shown());
      EXPECT_EQ(added.fault, "");
      if (added.correction) result = std::move(added.correction);
    }
    return result;
  }

  static void expect_same(const flow::GraphCorrection& a, const flow::GraphCorrection& b) {
    EXPECT_EQ(a.sequence, b.sequence);
    EXPECT_EQ(a.map_id, b.map_id);
    EXPECT_EQ(a.map_from_odom, b.map_from_odom);
    EXPECT_EQ(a.is_untied, b.is_untied);
    ASSERT_TRUE(a.georeference && b.georeference);
    EXPECT_EQ(a.georeference->has_position, b.georeference->has_position);
    EXPECT_EQ(a.georeference->origin.latitude_deg, b.georeference->origin.latitude_deg);
    EXPECT_EQ(a.georeference->origin.longitude_deg, b.georeference->origin.longitude_deg);
    EXPECT_EQ(a.georeference->x_from_east_rad, b.georeference->x_from_east_rad);
    EXPECT_EQ(a.georeference->position_sigma_m, b.georeference->position_sigma_m);
    EXPECT_EQ(a.georeference->fixes, b.georeference->fixes);
    EXPECT_EQ(a.georeference->rejected_fixes, b.georeference->rejected_fixes);
    ASSERT_EQ(a.submaps.size(), b.submaps.size());
    for (std::size_t i = 0; i < a.submaps.size(); ++i) {
      EXPECT_EQ(a.submaps[i].submap_id, b.submaps[i].submap_id);
      EXPECT_EQ(a.submaps[i].map_from_submap, b.submaps[i].map_from_submap);
    }
  }
};

TEST_F(GraphCorrectionInParts, ComesBackAsItWas) {
  for (const std::uint32_t submaps :
       {0U, 1U, kMostSubmapsOfPart, kMostSubmapsOfPart + 1, 3 * kMostSubmapsOfPart}) {
    const flow::GraphCorrection whole = correction(submaps, submaps);
    auto parts = parts_of(whole);
    std::reverse(parts.begin(), parts.end());
    const auto back = assemble(parts);
    ASSERT_TRUE(back.has_value()) << submaps;
    expect_same(*back, whole);
  }
}

TEST_F(GraphCorrectionInParts, DoesNotComeWhereAPartIsMissing) {
  auto parts = parts_of(correction(1, 2 * kMostSubmapsOfPart));
  ASSERT_EQ(parts.size(), 2U);
  parts.pop_back();
  EXPECT_FALSE(assemble(parts).has_value());
}

TEST_F(GraphCorrectionInParts, IsNotMixedUpWithAnOlderOneOfTheSameNumber) {
  auto old_parts = parts_of(correction(1, 2 * kMostSubmapsOfPart));
  old_parts.pop_back();
  EXPECT_FALSE(assemble(old_parts).has_value());
  const flow::GraphCorrection newer = correction(1, 2 * kMostSubmapsOfPart);
  auto parts = parts_of(newer);
  const auto back = assemble(parts);
  ASSERT_TRUE(back.has_value());
  expect_same(*back, newer);
}

TEST_F(GraphCorrectionInParts, AreRefusedWhereTheyAreUnsound) {
  const flow::GraphCorrection whole = correction(1, 3);
  const auto fault_after = [&](auto corrupt) {
    KeptPart part = parts_of(whole).front();
    corrupt(part.shown());
    return GraphCorrectionAssembler().add(part.sample).fault;
  };
  EXPECT_EQ(fault_after([](auto&) {}), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_count = 0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_count = kMostParts + 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.part_index = 1; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.map_from_odom.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.georeference._buffer[0].latitude_deg = 91.0; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.georeference._buffer[0].position_sigma_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.submaps._buffer[1].map_from_submap.x_m = kNan; }), "");
  EXPECT_NE(fault_after([](auto& s) { s.submaps._buffer[1].submap_id = 0; }), "");
}

}  // namespace
}  // namespace slammot::wire
