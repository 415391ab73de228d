#include "common/association/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace slammot::association {
namespace {

/// Tries every assignment.
double cheapest_by_trying_all(const CostMatrix& costs, double cost_of_leaving_out,
                              std::size_t row = 0, std::set<std::size_t> used = {}) {
  if (row == costs.rows) return 0.0;
  double best =
      cost_of_leaving_out + cheapest_by_trying_all(costs, cost_of_leaving_out, row + 1, used);
  for (std::size_t column = 0; column < costs.columns; ++column) {
    if (used.contains(column) || costs(row, column) == kForbidden) continue;
    used.insert(column);
    best = std::min(best, costs(row, column) +
                              cheapest_by_trying_all(costs, cost_of_leaving_out, row + 1, used));
    used.erase(column);
  }
  return best;
}

CostMatrix random_costs(std::mt19937_64& random, std::size_t rows, std::size_t columns,
                        double forbidden_share) {
  std::uniform_real_distribution<double> uniform;
  CostMatrix costs(rows, columns, 0.0);
  for (double& cost : costs.cost)
    cost = uniform(random) < forbidden_share ? kForbidden : 20.0 * uniform(random) - 5.0;
  return costs;
}

bool uses_no_column_twice(const std::vector<std::size_t>& column_of_row) {
  std::set<std::size_t> seen;
  return std::all_of(column_of_row.begin(), column_of_row.end(), [&](std::size_t column) {
    return column == kUnassigned || seen.insert(column).second;
  });
}

TEST(Assign, CostsAsLittleAsTheBestOfAllAssignments) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 400; ++trial) {
    const CostMatrix costs =
        random_costs(random, random() % 6, random() % 6, 0.1 * static_cast<double>(trial % 10));
    const auto column_of_row = assign(costs, 9.0);
    ASSERT_TRUE(uses_no_column_twice(column_of_row));
    ASSERT_NEAR(assignment_cost(costs, 9.0, column_of_row), cheapest_by_trying_all(costs, 9.0),
                1e-9);
  }
}

TEST(Assign, NeverMakesAForbiddenPair) {
  const CostMatrix costs(3, 3, kForbidden);
  EXPECT_EQ(assign(costs, 1.0), std::vector<std::size_t>(3, kUnassigned));
}

TEST(Assign, LeavesARowOutWhenThatIsCheaper) {
  CostMatrix costs(1, 1, 5.0);
  EXPECT_EQ(assign(costs, 4.0).front(), kUnassigned);
  EXPECT_EQ(assign(costs, 6.0).front(), 0U);
}

TEST(Assign, GivesUpANearPairWhereTheWholeBecomesCheaper) {
  CostMatrix costs(2, 2, 0.0);
  costs(0, 0) = 1.0, costs(0, 1) = 2.0;
  costs(1, 0) = 1.5, costs(1, 1) = 30.0;
  const auto column_of_row = assign(costs, 50.0);
  EXPECT_EQ(column_of_row[0], 1U);
  EXPECT_EQ(column_of_row[1], 0U);
}

TEST(Assign, MovesWithThePermutationOfTheColumns) {
  std::mt19937_64 random(11);
  const CostMatrix costs = random_costs(random, 7, 9, 0.3);
  CostMatrix reversed = costs;
  for (std::size_t row = 0; row < costs.rows; ++row)
    for (std::size_t column = 0; column < costs.columns; ++column)
      reversed(row, costs.columns - 1 - column) = costs(row, column);
  const auto direct = assign(costs, 9.0);
  const auto mirrored = assign(reversed, 9.0);
  for (std::size_t row = 0; row < costs.rows; ++row)
    EXPECT_EQ(direct[row] == kUnassigned ? kUnassigned : costs.columns - 1 - direct[row],
              mirrored[row]);
}

}  // namespace
}  // namespace slammot::association
