#include "common/association/ranked_assignments.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

namespace slammot::association {

const std::vector<RankedAssignment>& AssignmentRanking::rank(const CostMatrix& costs,
                                                             double cost_of_leaving_out,
                                                             std::size_t count) {
  assert(count >= 1);
  costs_ = &costs;
  cost_of_leaving_out_ = cost_of_leaving_out;
  columns_ = costs.columns + costs.rows;
  std::move(results_.begin(), results_.end(), std::back_inserter(spare_results_));
  results_.clear();
  unused_.insert(unused_.end(), heap_.begin(), heap_.end());
  heap_.clear();
  const std::size_t whole = take_subproblem();
  pool_[whole].fixed_rows = 0;
  pool_[whole].is_excluded.assign(columns_, 0);
  if (solve(pool_[whole])) push(whole);
  while (!heap_.empty() && results_.size() < count) {
    const std::size_t best = pop();
    add_result(pool_[best]);
    if (results_.size() < count) branch(best);
    unused_.push_back(best);
  }
  return results_;
}

/// Partitions the rest of a subproblem without its cheapest assignment (Murty 1968): for each free
/// row, the assignments that agree with the cheapest one before that row and differ in it.
void AssignmentRanking::branch(std::size_t index) {
  for (std::size_t row = pool_[index].fixed_rows; row < costs_->rows; ++row) {
    const std::size_t child = take_subproblem();
    const Subproblem& parent = pool_[index];
    Subproblem& part = pool_[child];
    part.fixed_rows = row;
    part.column_of_row = parent.column_of_row;
    if (row == parent.fixed_rows) part.is_excluded = parent.is_excluded;
    else part.is_excluded.assign(columns_, 0);
    part.is_excluded[parent.column_of_row[row]] = 1;
    if (solve(part)) push(child);
    else unused_.push_back(child);
  }
}

double AssignmentRanking::cost_of(const Subproblem& subproblem, std::size_t row,
                                  std::size_t column) const {
  if (row < subproblem.fixed_rows && column != subproblem.column_of_row[row]) return kForbidden;
  if (row == subproblem.fixed_rows && subproblem.is_excluded[column]) return kForbidden;
  if (column < costs_->columns) return (*costs_)(row, column);
  return column - costs_->columns == row ? cost_of_leaving_out_ : kForbidden;
}

/// Returns false if the exclusions leave no assignment.
bool AssignmentRanking::solve(Subproblem& subproblem) {
  paths_.begin(costs_->rows, columns_);
  for (std::size_t row = 0; row < costs_->rows; ++row)
    if (!paths_.add(
            row, [&](std::size_t i, std::size_t column) { return cost_of(subproblem, i, column); }))
      return false;
  subproblem.column_of_row.resize(costs_->rows);
  subproblem.cost = 0.0;
  for (std::size_t column = 0; column < columns_; ++column) {
    const std::size_t row = paths_.row_of_column(column);
    if (row == kUnassigned) continue;
    subproblem.column_of_row[row] = column;
    subproblem.cost += column < costs_->columns ? (*costs_)(row, column) : cost_of_leaving_out_;
  }
  return true;
}

std::size_t AssignmentRanking::take_subproblem() {
  if (unused_.empty()) {
    pool_.emplace_back();
    return pool_.size() - 1;
  }
  const std::size_t index = unused_.back();
  unused_.pop_back();
  return index;
}

void AssignmentRanking::push(std::size_t index) {
  heap_.push_back(index);
  std::push_heap(heap_.begin(), heap_.end(),
                 [&](std::size_t a, std::size_t b) { return pool_[a].cost > pool_[b].cost; });
}

std::size_t AssignmentRanking::pop() {
  std::pop_heap(heap_.begin(), heap_.end(),
                [&](std::size_t a, std::size_t b) { return pool_[a].cost > pool_[b].cost; });
  const std::size_t index = heap_.back();
  heap_.pop_back();
  return index;
}

void AssignmentRanking::add_result(const Subproblem& subproblem) {
  if (spare_results_.empty()) {
    results_.emplace_back();
  } else {
    results_.push_back(std::move(spare_results_.back()));
    spare_results_.pop_back();
  }
  RankedAssignment& result = results_.back();
  result.cost = subproblem.cost;
  result.column_of_row = subproblem.column_of_row;
  for (std::size_t& column : result.column_of_row)
    if (column >= costs_->columns) column = kUnassigned;
}

}  // namespace slammot::association
