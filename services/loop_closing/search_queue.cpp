#include "services/loop_closing/search_queue.hpp"

#include <algorithm>
#include <utility>

namespace slammot::loop_closing {

void SearchQueue::add(RevisitSearch search, Extent extent) {
  waiting_.push_back({std::move(search), extent});
  if (waiting_.size() <= static_cast<std::size_t>(budget_.most_waiting)) return;
  // A search everywhere is given up first: it is one of many attempts.
  auto oldest = std::ranges::find(waiting_, Extent::kEverywhere, &Waiting::extent);
  if (oldest == waiting_.end()) oldest = waiting_.begin();
  displaced_.push_back(end(oldest, true));
}

std::vector<SearchQueue::Finished> SearchQueue::advance() {
  return advance(budget_.work_per_submap, everywhere_share() * budget_.work_per_submap);
}

double SearchQueue::everywhere_share() const {
  return static_cast<double>(budget_.patience) / std::max(budget_.patience, failures_in_a_row_);
}

std::vector<SearchQueue::Finished> SearchQueue::advance(double most_work, double most_everywhere) {
  std::vector<Finished> finished = std::exchange(displaced_, {});
  double left = most_work;
  double left_everywhere = most_everywhere;
  while (!waiting_.empty()) {
    const auto current = next();
    const bool is_everywhere = current->extent == Extent::kEverywhere;
    const double left_now = is_everywhere ? std::min(left, left_everywhere) : left;
    if (left_now <= 0.0) break;
    const double left_of_search =
        budget_.work_per_search - static_cast<double>(current->search.work());
    const std::uint64_t done = current->search.advance(
        static_cast<std::uint64_t>(std::max(std::min(left_now, left_of_search), 1.0)), pyramids_);
    left -= static_cast<double>(done);
    if (is_everywhere) left_everywhere -= static_cast<double>(done);
    work_ += done;
    const bool is_exhausted =
        static_cast<double>(current->search.work()) >= budget_.work_per_search;
    if (current->search.is_done() || is_exhausted)
      finished.push_back(end(current, !current->search.is_done()));
  }
  return finished;
}

std::vector<SearchQueue::Finished> SearchQueue::finish() {
  std::vector<Finished> finished =
      advance(budget_.work_at_end, everywhere_share() * budget_.work_at_end);
  while (!waiting_.empty()) finished.push_back(end(waiting_.begin(), true));
  return finished;
}

std::deque<SearchQueue::Waiting>::iterator SearchQueue::next() {
  const auto near = std::ranges::find_if(
      waiting_, [](const Waiting& one) { return one.search.is_near_expected(); });
  if (near != waiting_.end()) return near;
  const auto expected = std::ranges::find(waiting_, Extent::kExpected, &Waiting::extent);
  return expected == waiting_.end() ? waiting_.begin() : expected;
}

SearchQueue::Finished SearchQueue::end(std::deque<Waiting>::iterator waiting, bool is_given_up) {
  Finished finished{waiting->search.source(),
                    waiting->extent,
                    waiting->search.found(),
                    waiting->search.target(),
                    waiting->search.searched_sigma_m(),
                    is_given_up};
  if (is_given_up) ++given_up_;
  if (waiting->extent == Extent::kEverywhere)
    failures_in_a_row_ = finished.hypotheses.empty() ? failures_in_a_row_ + 1 : 0;
  waiting_.erase(waiting);
  return finished;
}

}  // namespace slammot::loop_closing
