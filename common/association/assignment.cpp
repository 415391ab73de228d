#include "common/association/assignment.hpp"

#include <cassert>

namespace slammot::association {
namespace {

bool worth_pairing(const CostMatrix& costs, std::size_t row, std::size_t column,
                   double cost_of_leaving_out) {
  return costs(row, column) < cost_of_leaving_out;
}

}  // namespace

/// Connected component of the graph of finite-cost pairs (cheaper than leaving out) that contains
/// the row.
void Assigner::find_cluster_of(std::size_t first_row, const CostMatrix& costs,
                               double cost_of_leaving_out) {
  cluster_.rows.assign(1, first_row);
  cluster_.columns.clear();
  row_taken_[first_row] = 1;
  for (std::size_t next = 0; next < cluster_.rows.size(); ++next) {
    for (std::size_t column = 0; column < costs.columns; ++column) {
      if (column_taken_[column] ||
          !worth_pairing(costs, cluster_.rows[next], column, cost_of_leaving_out))
        continue;
      column_taken_[column] = 1;
      cluster_.columns.push_back(column);
      for (std::size_t row = 0; row < costs.rows; ++row) {
        if (row_taken_[row] || !worth_pairing(costs, row, column, cost_of_leaving_out)) continue;
        row_taken_[row] = 1;
        cluster_.rows.push_back(row);
      }
    }
  }
}

/// Every row has one extra column that means "unassigned", so that a complete assignment always
/// exists.
void Assigner::solve(const CostMatrix& costs, double cost_of_leaving_out) {
  const std::size_t columns = cluster_.columns.size();
  const auto cost = [&](std::size_t row, std::size_t column) {
    if (column < columns) return costs(cluster_.rows[row], cluster_.columns[column]);
    return column - columns == row ? cost_of_leaving_out : kForbidden;
  };
  paths_.begin(cluster_.rows.size(), columns + cluster_.rows.size());
  for (std::size_t row = 0; row < cluster_.rows.size(); ++row) {
    const bool is_added = paths_.add(row, cost);
    assert(is_added);
    static_cast<void>(is_added);
  }
  for (std::size_t column = 0; column < columns; ++column)
    if (paths_.row_of_column(column) != kUnassigned)
      column_of_row_[cluster_.rows[paths_.row_of_column(column)]] = cluster_.columns[column];
}

const std::vector<std::size_t>& Assigner::assign(const CostMatrix& costs,
                                                 double cost_of_leaving_out) {
  column_of_row_.assign(costs.rows, kUnassigned);
  row_taken_.assign(costs.rows, 0);
  column_taken_.assign(costs.columns, 0);
  for (std::size_t row = 0; row < costs.rows; ++row) {
    if (row_taken_[row]) continue;
    find_cluster_of(row, costs, cost_of_leaving_out);
    if (cluster_.rows.size() == 1 && cluster_.columns.size() == 1)
      column_of_row_[row] = cluster_.columns.front();
    else if (!cluster_.columns.empty()) solve(costs, cost_of_leaving_out);
  }
  return column_of_row_;
}

std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out) {
  return Assigner().assign(costs, cost_of_leaving_out);
}

double assignment_cost(const CostMatrix& costs, double cost_of_leaving_out,
                       const std::vector<std::size_t>& column_of_row) {
  double total = 0.0;
  for (std::size_t row = 0; row < costs.rows; ++row)
    total +=
        column_of_row[row] == kUnassigned ? cost_of_leaving_out : costs(row, column_of_row[row]);
  return total;
}

}  // namespace slammot::association
