#include "services/loop_closing/islands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slammot::loop_closing {
namespace {

using flow::Constraint;
using flow::CorrectedSubmap;
using flow::SubmapId;
using ::testing::ElementsAre;
using ::testing::Pair;

std::vector<CorrectedSubmap> submaps(std::uint32_t count) {
  std::vector<CorrectedSubmap> all;
  for (std::uint32_t id = 0; id < count; ++id) all.push_back({{id}, {}});
  return all;
}

Constraint tie(std::uint32_t from, std::uint32_t to) {
  return {{from}, {to}, flow::ConstraintKind::kOdometric, {}};
}

auto is_on(std::uint32_t id, std::uint32_t island) { return Pair(SubmapId{id}, SubmapId{island}); }

TEST(Islands, AreNamedByTheirEarliestSubmap) {
  const std::vector<Constraint> ties{tie(0, 1), tie(2, 3), tie(3, 4)};
  EXPECT_THAT(islands(submaps(6), ties), ElementsAre(is_on(0, 0), is_on(1, 0), is_on(2, 2),
                                                     is_on(3, 2), is_on(4, 2), is_on(5, 5)));
}

TEST(Islands, AreJoinedByOneConstraintInEitherDirection) {
  for (const Constraint& revisit : {tie(1, 4), tie(4, 1)}) {
    const std::vector<Constraint> ties{tie(2, 3), tie(0, 1), tie(3, 4), revisit};
    EXPECT_THAT(islands(submaps(5), ties),
                ElementsAre(is_on(0, 0), is_on(1, 0), is_on(2, 0), is_on(3, 0), is_on(4, 0)));
  }
}

}  // namespace
}  // namespace slammot::loop_closing
