#include "common/association/assignment.hpp"

#include <cassert>

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
Cluster cluster_of(std::size_t first_row, const CostMatrix& costs, double cost_of_leaving_out,
                   std::vector<char>& row_taken, std::vector<char>& column_taken) {
  Cluster cluster;
  cluster.rows.push_back(first_row);
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
  return cluster;
}

/// Shortest augmenting paths with potentials over one cluster. Every row also has a column of its own that stands for
/// leaving it out, so that a complete assignment always exists.
class ClusterSolver {
 public:
  ClusterSolver(const CostMatrix& costs, const Cluster& cluster, double cost_of_leaving_out)
      : costs_(costs), cluster_(cluster), cost_of_leaving_out_(cost_of_leaving_out),
        columns_(cluster.columns.size() + cluster.rows.size()),
        row_potential_(cluster.rows.size(), 0.0), column_potential_(columns_ + 1, 0.0),
        row_of_column_(columns_ + 1, kUnassigned) {}

  void solve(std::vector<std::size_t>& column_of_row) {
    for (std::size_t row = 0; row < cluster_.rows.size(); ++row) augment(row);
    for (std::size_t column = 0; column < cluster_.columns.size(); ++column)
      if (row_of_column_[column] != kUnassigned)
        column_of_row[cluster_.rows[row_of_column_[column]]] = cluster_.columns[column];
  }

 private:
  double cost(std::size_t row, std::size_t column) const {
    if (column < cluster_.columns.size()) return costs_(cluster_.rows[row], cluster_.columns[column]);
    return column - cluster_.columns.size() == row ? cost_of_leaving_out_ : kForbidden;
  }

  /// Finds the cheapest alternating path from a new row to a free column and flips it.
  void augment(std::size_t new_row) {
    const std::size_t start = columns_;  // a column that only the new row occupies
    row_of_column_[start] = new_row;
    std::vector<double> distance(columns_ + 1, kForbidden);
    std::vector<std::size_t> previous(columns_ + 1, start);
    std::vector<char> visited(columns_ + 1, 0);
    std::size_t column = start;
    do {
      visited[column] = 1;
      const std::size_t row = row_of_column_[column];
      double nearest = kForbidden;
      std::size_t next = start;
      for (std::size_t j = 0; j < columns_; ++j) {
        if (visited[j]) continue;
        const double reduced = cost(row, j) - row_potential_[row] - column_potential_[j];
        if (reduced < distance[j]) {
          distance[j] = reduced;
          previous[j] = column;
        }
        if (distance[j] < nearest) {
          nearest = distance[j];
          next = j;
        }
      }
      assert(nearest < kForbidden);
      for (std::size_t j = 0; j <= columns_; ++j) {
        if (visited[j]) {
          row_potential_[row_of_column_[j]] += nearest;
          column_potential_[j] -= nearest;
        } else {
          distance[j] -= nearest;
        }
      }
      column = next;
    } while (row_of_column_[column] != kUnassigned);
    for (; column != start; column = previous[column]) row_of_column_[column] = row_of_column_[previous[column]];
  }

  const CostMatrix& costs_;
  const Cluster& cluster_;
  double cost_of_leaving_out_;
  std::size_t columns_;
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  std::vector<std::size_t> row_of_column_;
};

}  // namespace

std::vector<std::size_t> assign(const CostMatrix& costs, double cost_of_leaving_out) {
  std::vector<std::size_t> column_of_row(costs.rows, kUnassigned);
  std::vector<char> row_taken(costs.rows, 0);
  std::vector<char> column_taken(costs.columns, 0);
  for (std::size_t row = 0; row < costs.rows; ++row) {
    if (row_taken[row]) continue;
    const Cluster cluster = cluster_of(row, costs, cost_of_leaving_out, row_taken, column_taken);
    if (cluster.rows.size() == 1 && cluster.columns.size() == 1)
      column_of_row[row] = cluster.columns.front();
    else if (!cluster.columns.empty())
      ClusterSolver(costs, cluster, cost_of_leaving_out).solve(column_of_row);
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
