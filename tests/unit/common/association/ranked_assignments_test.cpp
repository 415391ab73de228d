#include "common/association/ranked_assignments.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace slammot::association {
namespace {

/// Costs of all assignments, ascending.
void all_costs(const CostMatrix& costs, double cost_of_leaving_out, std::size_t row,
               std::set<std::size_t>& used, double sum, std::vector<double>& found) {
  if (row == costs.rows) return found.push_back(sum);
  all_costs(costs, cost_of_leaving_out, row + 1, used, sum + cost_of_leaving_out, found);
  for (std::size_t column = 0; column < costs.columns; ++column) {
    if (used.contains(column) || costs(row, column) == kForbidden) continue;
    used.insert(column);
    all_costs(costs, cost_of_leaving_out, row + 1, used, sum + costs(row, column), found);
    used.erase(column);
  }
}

std::vector<double> all_costs(const CostMatrix& costs, double cost_of_leaving_out) {
  std::vector<double> found;
  std::set<std::size_t> used;
  all_costs(costs, cost_of_leaving_out, 0, used, 0.0, found);
  std::sort(found.begin(), found.end());
  return found;
}

CostMatrix random_costs(std::mt19937_64& random, std::size_t rows, std::size_t columns,
                        double forbidden_share) {
  std::uniform_real_distribution<double> uniform;
  CostMatrix costs(rows, columns, 0.0);
  for (double& cost : costs.cost)
    cost = uniform(random) < forbidden_share ? kForbidden : 20.0 * uniform(random) - 5.0;
  return costs;
}

TEST(AssignmentRanking, FindsTheSameAsTryingAllAndSorting) {
  std::mt19937_64 random(3);
  AssignmentRanking ranking;
  for (int trial = 0; trial < 300; ++trial) {
    const CostMatrix costs =
        random_costs(random, random() % 5, random() % 5, 0.1 * static_cast<double>(trial % 10));
    const std::vector<double> expected = all_costs(costs, 9.0);
    const std::size_t wanted = 1 + random() % 40;
    const auto& ranked = ranking.rank(costs, 9.0, wanted);
    ASSERT_EQ(ranked.size(), std::min(wanted, expected.size()));
    std::set<std::vector<std::size_t>> different;
    for (std::size_t i = 0; i < ranked.size(); ++i) {
      ASSERT_NEAR(ranked[i].cost, expected[i], 1e-9) << trial;
      ASSERT_NEAR(assignment_cost(costs, 9.0, ranked[i].column_of_row), ranked[i].cost, 1e-9);
      ASSERT_TRUE(different.insert(ranked[i].column_of_row).second);
    }
  }
}

TEST(AssignmentRanking, BeginsWithTheBestAssignment) {
  std::mt19937_64 random(5);
  AssignmentRanking ranking;
  for (int trial = 0; trial < 50; ++trial) {
    const CostMatrix costs = random_costs(random, 8, 7, 0.4);
    EXPECT_NEAR(ranking.rank(costs, 9.0, 1).front().cost,
                assignment_cost(costs, 9.0, assign(costs, 9.0)), 1e-9);
  }
}

TEST(AssignmentRanking, GivesTheOneWayToPairNothing) {
  AssignmentRanking ranking;
  const auto& ranked = ranking.rank(CostMatrix(0, 3, 1.0), 9.0, 5);
  ASSERT_EQ(ranked.size(), 1U);
  EXPECT_EQ(ranked.front().cost, 0.0);
}

TEST(AssignmentRanking, CountsLeavingEachRowOutAsAWay) {
  AssignmentRanking ranking;
  const auto& ranked = ranking.rank(CostMatrix(2, 1, 1.0), 5.0, 10);
  ASSERT_EQ(ranked.size(), 3U);  // either row has the column, or none
  EXPECT_EQ(ranked[0].cost, 6.0);
  EXPECT_EQ(ranked[1].cost, 6.0);
  EXPECT_EQ(ranked[2].cost, 10.0);
}

TEST(AssignmentRanking, KeepsItsMemoryForTheNextProblem) {
  std::mt19937_64 random(7);
  const CostMatrix costs = random_costs(random, 6, 6, 0.2);
  AssignmentRanking ranking;
  ranking.rank(costs, 9.0, 10);
  const std::size_t* const before = ranking.rank(costs, 9.0, 10).back().column_of_row.data();
  std::set<const std::size_t*> places;
  for (int i = 0; i < 20; ++i)
    for (const RankedAssignment& one : ranking.rank(costs, 9.0, 10))
      places.insert(one.column_of_row.data());
  EXPECT_EQ(places.size(), 10U);
  EXPECT_TRUE(places.contains(before));
}

}  // namespace
}  // namespace slammot::association
