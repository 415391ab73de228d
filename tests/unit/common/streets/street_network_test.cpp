#include "common/streets/street_network.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace slammot::streets {
namespace {

using geometry::Vector2;

/// Through street with a side street in its middle, digitized 0.1 m beside it, and one far away.
StreetNetwork side_street() {
  return StreetNetwork(StreetGraph{{},
                                   {{"main", {{-80.0, 0.0}, {0.0, 0.0}, {80.0, 0.0}}},
                                    {"side", {{0.1, 0.0}, {0.0, 60.0}}},
                                    {"far", {{500.0, 0.0}, {500.0, 60.0}}}}});
}

const Node& node_at(const StreetNetwork& network, const Vector2& place_m) {
  return *std::ranges::min_element(
      network.nodes(), {}, [&](const Node& node) { return (node.place_m - place_m).norm(); });
}

TEST(StreetNetwork, SplitsAStreetWhereAnotherMeetsIt) {
  const StreetNetwork network = side_street();
  EXPECT_EQ(network.links().size(), 4U);
  EXPECT_EQ(node_at(network, {0.0, 0.0}).arms, 3);
  EXPECT_EQ(node_at(network, {80.0, 0.0}).arms, 1);
}

TEST(StreetNetwork, KnowsWhichStreetsMeet) {
  const StreetNetwork network = side_street();
  EXPECT_TRUE(network.are_joined(0, 1));
  EXPECT_TRUE(network.are_joined(0, 2));
  EXPECT_FALSE(network.are_joined(0, 3));
}

TEST(StreetNetwork, KeepsPointsOfABendWithinALink) {
  const StreetNetwork network(StreetGraph{{}, {{"bend", {{0.0, 0.0}, {30.0, 0.0}, {60.0, 10.0}}}}});
  ASSERT_EQ(network.links().size(), 1U);
  ASSERT_EQ(network.segments().size(), 2U);
  EXPECT_DOUBLE_EQ(network.segments()[0].share_from, 0.0);
  EXPECT_DOUBLE_EQ(network.segments()[0].share_to, network.segments()[1].share_from);
  EXPECT_DOUBLE_EQ(network.segments()[1].share_to, 1.0);
}

}  // namespace
}  // namespace slammot::streets
