#pragma once

#include <cstddef>
#include <vector>

#include "common/association/assignment.hpp"
#include "common/association/augmenting_paths.hpp"

namespace slammot::association {

/// One of several ways to pair rows with columns.
struct RankedAssignment {
  double cost = 0.0;                        ///< As assignment_cost() gives it.
  std::vector<std::size_t> column_of_row;   ///< kUnassigned where a row is left out.
};

/// Finds the cheapest assignments in ascending order of cost; Murty 1968, with the subproblems' rows fixed from the front.
/// Memory is kept from one call to the next: problems no larger than those before allocate nothing.
class AssignmentRanking {
 public:
  /// The `count` (>= 1) cheapest assignments, or as many as there are; costs as in `assign`, all finite or kForbidden.
  /// O(count * rows) assignment problems of O((rows + columns)^3) each: for clusters, not for whole scans. What is returned
  /// stays valid until the next call.
  const std::vector<RankedAssignment>& rank(const CostMatrix& costs, double cost_of_leaving_out, std::size_t count);

 private:
  /// Assignments that begin with the same pairs and lack some for the row after them, with the cheapest of them.
  struct Subproblem {
    double cost = 0.0;
    std::size_t fixed_rows = 0;                      ///< Rows before this one keep their column of column_of_row.
    std::vector<std::size_t> column_of_row;          ///< As in `Problem`: a row's own column stands for leaving it out.
    std::vector<char> is_excluded;                   ///< Columns that row fixed_rows must not have.
  };

  bool solve(Subproblem& subproblem);
  double cost_of(const Subproblem& subproblem, std::size_t row, std::size_t column) const;
  std::size_t take_subproblem();
  void push(std::size_t index);
  std::size_t pop();
  void branch(std::size_t index);
  void add_result(const Subproblem& subproblem);

  const CostMatrix* costs_ = nullptr;
  double cost_of_leaving_out_ = 0.0;
  std::size_t columns_ = 0;                          ///< Real ones and, for each row, one of its own.
  std::vector<Subproblem> pool_;
  std::vector<std::size_t> unused_;
  std::vector<std::size_t> heap_;                    ///< Of subproblems, the cheapest first.
  std::vector<RankedAssignment> results_;
  std::vector<RankedAssignment> spare_results_;
  AugmentingPaths paths_;
};

}  // namespace slammot::association
