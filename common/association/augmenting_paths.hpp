#pragma once

#include <cstddef>
#include <vector>

#include "common/association/pairing_costs.hpp"

namespace slammot::association {

/// Builds a cheapest complete assignment row by row: shortest augmenting paths with potentials
/// (Jonker and Volgenant 1987). Reuses its memory: problems no larger than earlier ones allocate
/// nothing.
class AugmentingPaths {
 public:
  void begin(std::size_t rows, std::size_t columns) {
    columns_ = columns;
    row_potential_.assign(rows, 0.0);
    column_potential_.assign(columns + 1, 0.0);
    row_of_column_.assign(columns + 1, kUnassigned);
  }

  /// Finds the cheapest alternating path from a new row to a free column and flips it. cost(row,
  /// column) is finite or kForbidden. Returns false if the row cannot be added; the partial
  /// assignment is invalid then.
  template <class Cost>
  bool add(std::size_t new_row, const Cost& cost) {
    const std::size_t start = columns_;  // virtual column that only the new row occupies
    row_of_column_[start] = new_row;
    distance_.assign(columns_ + 1, kForbidden);
    previous_.assign(columns_ + 1, start);
    is_visited_.assign(columns_ + 1, 0);
    std::size_t column = start;
    do {
      is_visited_[column] = 1;
      const std::size_t row = row_of_column_[column];
      double nearest = kForbidden;
      std::size_t next = start;
      for (std::size_t j = 0; j < columns_; ++j) {
        if (is_visited_[j]) continue;
        const double reduced = cost(row, j) - row_potential_[row] - column_potential_[j];
        if (reduced < distance_[j]) {
          distance_[j] = reduced;
          previous_[j] = column;
        }
        if (distance_[j] < nearest) {
          nearest = distance_[j];
          next = j;
        }
      }
      if (nearest == kForbidden) return false;
      for (std::size_t j = 0; j <= columns_; ++j) {
        if (is_visited_[j]) {
          row_potential_[row_of_column_[j]] += nearest;
          column_potential_[j] -= nearest;
        } else {
          distance_[j] -= nearest;
        }
      }
      column = next;
    } while (row_of_column_[column] != kUnassigned);
    for (; column != start; column = previous_[column])
      row_of_column_[column] = row_of_column_[previous_[column]];
    return true;
  }

  /// Row of the column; kUnassigned if the column is free.
  std::size_t row_of_column(std::size_t column) const { return row_of_column_[column]; }

 private:
  std::size_t columns_ = 0;
  std::vector<double> row_potential_;
  std::vector<double> column_potential_;
  std::vector<std::size_t> row_of_column_;
  std::vector<double> distance_;
  std::vector<std::size_t> previous_;
  std::vector<char> is_visited_;
};

}  // namespace slammot::association
