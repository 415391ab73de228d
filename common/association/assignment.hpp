#pragma once

#include <cstddef>
#include <vector>

#include "common/association/augmenting_paths.hpp"
#include "common/association/pairing_costs.hpp"

namespace slammot::association {

/// Costs of pairing rows with columns, row-major.
struct CostMatrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> cost;

  CostMatrix() = default;
  CostMatrix(std::size_t row_count, std::size_t column_count, double value) { assign(row_count, column_count, value); }
  void assign(std::size_t row_count, std::size_t column_count, double value) {
    rows = row_count, columns = column_count;
    cost.assign(row_count * column_count, value);
  }
  double& operator()(std::size_t row, std::size_t column) { return cost[row * columns + column]; }
  double operator()(std::size_t row, std::size_t column) const { return cost[row * columns + column]; }
};

/// Pairs rows with columns, each at most once, such that the sum of the pairs' costs plus `cost_of_leaving_out` for
/// every row without a partner is smallest. Returns each row's column or kUnassigned. Costs are finite or kForbidden.
/// Splits the problem into clusters that share no finite cost below that of leaving out (Wang 2004, Figure 5.3) and
/// solves each by shortest augmenting paths (Jonker and Volgenant 1987), O(n^3) in a cluster.
std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out);

/// The same for problem after problem. Keeps its memory, so that problems no larger than those before allocate nothing.
class Assigner {
 public:
  /// Good until the next call.
  const std::vector<std::size_t>& assign(const CostMatrix& costs, double cost_of_leaving_out);

 private:
  /// Rows and columns that compete with one another and with nobody else.
  struct Cluster {
    std::vector<std::size_t> rows;
    std::vector<std::size_t> columns;
  };

  void find_cluster_of(std::size_t first_row, const CostMatrix& costs, double cost_of_leaving_out);
  void solve(const CostMatrix& costs, double cost_of_leaving_out);

  std::vector<std::size_t> column_of_row_;
  std::vector<char> row_taken_;
  std::vector<char> column_taken_;
  Cluster cluster_;
  AugmentingPaths paths_;
};

/// Sum of costs that `assign` minimizes.
double assignment_cost(const CostMatrix& costs, double cost_of_leaving_out, const std::vector<std::size_t>& column_of_row);

}  // namespace slammot::association
