#include "common/association/assignment.hpp"

#include <cassert>

#include "common/association/augmenting_paths.hpp"

namespace slammot::association {
namespace {

/// Rows and columns that compete with one another and with nobody else.
struct Cluster {
  std::vector<std::size_t> rows;
  std::vector<std::size_t> columns;
};

bool worth_pairing(const CostMatrix& costs, std::size_t row, std::size_t column, double cost_of_leaving_out) {
  return costs(row, column) < cost_of_leaving_out;
}

/// Connected component of the graph of worthwhile pairs that contains the row.
void find_cluster_of(std::size_t first_row, const CostMatrix& costs, double cost_of_leaving_out,
                     std::vector<char>& row_taken, std::vector<char>& column_taken, Cluster& cluster) {
  cluster.rows.assign(1, first_row);
  cluster.columns.clear();
  row_taken[first_row] = 1;
  for (std::size_t next = 0; next < cluster.rows.size(); ++next) {
    for (std::size_t column = 0; column < costs.columns; ++column) {
      if (column_taken[column] || !worth_pairing(costs, cluster.rows[next], column, cost_of_leaving_out)) continue;
      column_taken[column] = 1;
      cluster.columns.push_back(column);
      for (std::size_t row = 0; row < costs.rows; ++row) {
        if (row_taken[row] || !worth_pairing(costs, row, column, cost_of_leaving_out)) continue;
        row_taken[row] = 1;
        cluster.rows.push_back(row);
      }
    }
  }
}

/// Solves one cluster. Every row also has a column of its own that stands for leaving it out, so that a complete
/// assignment always exists.
void solve(const CostMatrix& costs, const Cluster& cluster, double cost_of_leaving_out, AugmentingPaths& paths, std::vector<std::size_t>& column_of_row) {
  const std::size_t columns = cluster.columns.size();
  const auto cost = [&](std::size_t row, std::size_t column) {
    if (column < columns) return costs(cluster.rows[row], cluster.columns[column]);
    return column - columns == row ? cost_of_leaving_out : kForbidden;
  };
  paths.begin(cluster.rows.size(), columns + cluster.rows.size());
  for (std::size_t row = 0; row < cluster.rows.size(); ++row) {
    const bool is_added = paths.add(row, cost);
    assert(is_added);
    static_cast<void>(is_added);
  }
  for (std::size_t column = 0; column < columns; ++column)
    if (paths.row_of_column(column) != kUnassigned) column_of_row[cluster.rows[paths.row_of_column(column)]] = cluster.columns[column];
}

}  // namespace

std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out) {
  std::vector<std::size_t> column_of_row(costs.rows, kUnassigned);
  std::vector<char> row_taken(costs.rows, 0);
  std::vector<char> column_taken(costs.columns, 0);
  Cluster cluster;
  AugmentingPaths paths;
  for (std::size_t row = 0; row < costs.rows; ++row) {
    if (row_taken[row]) continue;
    find_cluster_of(row, costs, cost_of_leaving_out, row_taken, column_taken, cluster);
    if (cluster.rows.size() == 1 && cluster.columns.size() == 1)
      column_of_row[row] = cluster.columns.front();
    else if (!cluster.columns.empty())
      solve(costs, cluster, cost_of_leaving_out, paths, column_of_row);
  }
  return column_of_row;
}

double assignment_cost(const CostMatrix& costs, double cost_of_leaving_out, const std::vector<std::size_t>& column_of_row) {
  double total = 0.0;
  for (std::size_t row = 0; row < costs.rows; ++row)
    total += column_of_row[row] == kUnassigned ? cost_of_leaving_out : costs(row, column_of_row[row]);
  return total;
}

}  // namespace slammot::association
