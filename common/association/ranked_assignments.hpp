#pragma once

#include <cstddef>
#include <vector>

#include "common/association/assignment.hpp"
#include "common/association/augmenting_paths.hpp"

namespace slammot::association {

/// One assignment of rows to columns.
struct RankedAssignment {
  double cost = 0.0;                       ///< See assignment_cost().
  std::vector<std::size_t> column_of_row;  ///< kUnassigned for an unassigned row.
};

/// Finds the cheapest assignments in ascending order of cost; Murty 1968, with rows fixed from the
/// front. Reuses its memory: problems no larger than earlier ones allocate nothing.
class AssignmentRanking {
 public:
  /// Returns the `count` (>= 1) cheapest assignments, or as many as exist. Costs as in `assign`:
  /// finite or kForbidden. Solves O(count * rows) assignment problems of O((rows + columns)^3)
  /// each: suited to clusters, not to whole scans. The result is valid until the next call.
  const std::vector<RankedAssignment>& rank(const CostMatrix& costs, double cost_of_leaving_out,
                                            std::size_t count);

 private:
  /// Subproblem: assignments with the first pairs fixed and some columns excluded for the next row,
  /// with the cheapest of them.
  struct Subproblem {
    double cost = 0.0;
    std::size_t fixed_rows = 0;  ///< Rows before this one keep their column in column_of_row.
    std::vector<std::size_t> column_of_row;  ///< As in `Problem`: a row's extra column means
                                             ///< "unassigned".
    std::vector<char> is_excluded;           ///< Columns that row fixed_rows must not have.
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
  std::size_t columns_ = 0;  ///< Real columns plus one extra column a row.
  std::vector<Subproblem> pool_;
  std::vector<std::size_t> unused_;
  std::vector<std::size_t> heap_;  ///< Subproblems, the cheapest first.
  std::vector<RankedAssignment> results_;
  std::vector<RankedAssignment> spare_results_;
  AugmentingPaths paths_;
};

}  // namespace slammot::association
