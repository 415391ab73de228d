#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace slammot::association {

/// Marks a pair that must not be made.
inline constexpr double kForbidden = std::numeric_limits<double>::infinity();
inline constexpr std::size_t kUnassigned = std::numeric_limits<std::size_t>::max();

/// Costs of pairing rows with columns, row-major.
struct CostMatrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> cost;

  CostMatrix() = default;
  CostMatrix(std::size_t row_count, std::size_t column_count, double value)
      : rows(row_count), columns(column_count), cost(row_count * column_count, value) {}
  double& operator()(std::size_t row, std::size_t column) { return cost[row * columns + column]; }
  double operator()(std::size_t row, std::size_t column) const { return cost[row * columns + column]; }
};

/// Pairs rows with columns, each at most once, such that the sum of the pairs' costs plus `cost_of_leaving_out` for
/// every row without a partner is smallest. Returns each row's column or kUnassigned. Costs are finite or kForbidden.
/// Splits the problem into clusters that share no finite cost below that of leaving out (Wang 2004, Figure 5.3) and
/// solves each by shortest augmenting paths (Jonker and Volgenant 1987), O(n^3) in a cluster.
std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out);

/// Sum of costs that `assign` minimizes.
double assignment_cost(const CostMatrix& costs, double cost_of_leaving_out, const std::vector<std::size_t>& column_of_row);

}  // namespace slammot::association
