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
  CostMatrix(std::size_t row_count, std::size_t column_count, double value) {
    assign(row_count, column_count, value);
  }
  void assign(std::size_t row_count, std::size_t column_count, double value) {
    rows = row_count, columns = column_count;
    cost.assign(row_count * column_count, value);
  }
  double& operator()(std::size_t row, std::size_t column) { return cost[row * columns + column]; }
  double operator()(std::size_t row, std::size_t column) const {
    return cost[row * columns + column];
  }
};

/// Assigns rows to columns, each at most once. Minimizes the sum of the pairs' costs plus
/// `cost_of_leaving_out` for each unassigned row. Returns each row's column or kUnassigned. Costs
/// are finite or kForbidden. The problem is split into clusters that share no cost below
/// `cost_of_leaving_out` (Wang 2004, Figure 5.3). Each cluster is solved by shortest augmenting
/// paths (Jonker and Volgenant 1987) in O(n^3).
std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out);

/// The same for a series of problems. Reuses its memory: problems no larger than earlier ones
/// allocate nothing.
class Assigner {
 public:
  /// The result is valid until the next call.
  const std::vector<std::size_t>& assign(const CostMatrix& costs, double cost_of_leaving_out);

 private:
  /// Rows and columns of one connected component of the assignment problem.
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
double assignment_cost(const CostMatrix& costs, double cost_of_leaving_out,
                       const std::vector<std::size_t>& column_of_row);

}  // namespace slammot::association
