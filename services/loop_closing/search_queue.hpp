#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "services/loop_closing/revisit.hpp"

namespace slammot::loop_closing {

struct SearchBudget {
  double work_per_submap = 60e6;   ///< Cells read per new submap; about 1 ns each.
  double work_per_search = 160e6;  ///< A search is given up after so many cells.
  double work_at_end = 80e6;       ///< For pending searches when the drive ends.
  int most_waiting = 6;            ///< With more pending searches the oldest is given up.
  int patience = 5;                ///< Unsuccessful searches everywhere in a row before each
                                   ///< further one reduces the share of the next.
};

/// Schedules searches in pieces of counted work: first near expected poses, then in their full
/// windows, then everywhere; within each stage, older searches first.
class SearchQueue {
 public:
  enum class Extent { kExpected, kEverywhere };

  struct Finished {
    flow::SubmapId source;
    Extent extent = Extent::kExpected;
    std::vector<Hypothesis> hypotheses;
    flow::SubmapId target;          ///< The first target.
    double searched_sigma_m = 0.0;  ///< One sigma of the expected position on it.
    bool is_given_up = false;       ///< Better poses may exist in the part not searched.
  };

  explicit SearchQueue(const SearchBudget& budget) : budget_(budget) {}

  void add(RevisitSearch search, Extent extent);

  /// Spends one submap's budget and returns the searches that ended. Each unsuccessful search
  /// everywhere in a row reduces the share of the next, so that the total cost in unmapped terrain
  /// grows with the logarithm of the distance.
  std::vector<Finished> advance();

  /// Spends the budget of the end of a drive, then gives up all pending searches.
  std::vector<Finished> finish();

  bool is_empty() const { return waiting_.empty(); }
  std::uint64_t given_up() const { return given_up_; }
  std::uint64_t work() const { return work_; }

 private:
  struct Waiting {
    RevisitSearch search;
    Extent extent;
  };
  std::vector<Finished> advance(double most_work, double most_everywhere);
  std::deque<Waiting>::iterator next();
  double everywhere_share() const;
  Finished end(std::deque<Waiting>::iterator waiting, bool is_given_up);

  SearchBudget budget_;
  PyramidCache pyramids_;
  std::deque<Waiting> waiting_;
  std::vector<Finished> displaced_;
  int failures_in_a_row_ = 0;  ///< Unsuccessful searches everywhere in a row.
  std::uint64_t given_up_ = 0;
  std::uint64_t work_ = 0;
};

}  // namespace slammot::loop_closing
