#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "services/loop_closing/revisit.hpp"

namespace slammot::loop_closing {

struct SearchBudget {
  double work_per_submap = 60e6;   ///< Cells that searches read for each submap that comes; about 1
                                   ///< ns each.
  double work_per_search = 160e6;  ///< A search that has read so many is given up.
  double work_at_end = 80e6;       ///< For what is left when the drive ends.
  int most_waiting = 6;            ///< Searches that wait; more, and the oldest is given up.
};

/// Searches that take turns, in pieces of counted work: near expected poses first, then all around
/// these, then everywhere; older ones first.
class SearchQueue {
 public:
  enum class Extent { kExpected, kEverywhere };

  struct Finished {
    flow::SubmapId source;
    Extent extent = Extent::kExpected;
    std::vector<Hypothesis> hypotheses;
    flow::SubmapId target;          ///< The only one, or the first.
    double searched_sigma_m = 0.0;  ///< How unsure the pose on it was.
    bool is_given_up = false;       ///< Better poses may exist on what was not looked at.
  };

  explicit SearchQueue(const SearchBudget& budget) : budget_(budget) {}

  void add(RevisitSearch search, Extent extent);

  /// Does the work that one submap buys; the searches that ended. The more searches everywhere
  /// found nothing in a row, the less each submap buys of them: a place that was never seen costs
  /// no more than the logarithm of the way through it.
  std::vector<Finished> advance();

  /// Does the work that the end of a drive buys, then gives up what is left.
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
  std::vector<Finished> crowded_out_;
  int in_vain_ = 0;  ///< Searches everywhere in a row that found nothing.
  std::uint64_t given_up_ = 0;
  std::uint64_t work_ = 0;
};

}  // namespace slammot::loop_closing
