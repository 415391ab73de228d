#include "common/matching/timing_window.hpp"

#include <algorithm>
#include <cmath>

#include "common/matching/common_factor.hpp"

namespace slammot::matching {
namespace {

constexpr std::size_t kFewestInWindow = 5;
constexpr double kLogFactorSigma = 0.1;  // of the common factor of turns, and of ways: that of a
                                         // log is known before
constexpr std::size_t kBendOver = 2;     // delays to either side: there the errors are a parabola

}  // namespace

double TimingEvidence::gain_over(double delay_s) const {
  const double place = std::clamp((delay_s + TimingDelays::kReach_s) / TimingDelays::kStep_s, 0.0,
                                  static_cast<double>(TimingDelays::kCount - 1));
  const auto before = std::min(static_cast<std::size_t>(place), TimingDelays::kCount - 2);
  const double share = place - static_cast<double>(before);
  const double error = (1.0 - share) * errors[before] + share * errors[before + 1];
  return (error - std::ranges::min(errors)) / std::max(usual_error, 1.0);
}

void TimingWindow::add(const TimedQuantity& quantity) {
  Kind& kind = kinds_[static_cast<std::size_t>(quantity.change)];
  kind.last[kind.count++ % kMostOfAKind] = quantity;
}

std::size_t TimingWindow::size() const {
  std::size_t all = 0;
  for (const Kind& kind : kinds_) all += kind.size();
  return all;
}

template <typename Entry, typename EntryOf>
TimingWindow::Entries<Entry> TimingWindow::collect(bool of_turns, EntryOf entry_of) const {
  Entries<Entry> entries;
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    if (is_of_turn(static_cast<MotionChange>(i)) != of_turns) continue;
    for (std::size_t k = 0; k < kinds_[i].size(); ++k)
      entries.all[entries.count++] = entry_of(kinds_[i].last[k]);
  }
  return entries;
}

double TimingWindow::error_at(std::size_t delay, bool of_turns) const {
  return error_with_best_factor(
      collect<TwiceMeasured>(
          of_turns,
          [&](const TimedQuantity& quantity) {
            return TwiceMeasured{quantity.by_scans, quantity.sigma, quantity.by_odometry[delay]};
          })
          .used(),
      kLogFactorSigma);
}

double TimingWindow::information_at(std::size_t delay, bool of_turns) const {
  constexpr double kApart_s = 2.0 * static_cast<double>(kBendOver) * TimingDelays::kStep_s;
  return information_about_delay(
      collect<DelayedQuantity>(of_turns,
                               [&](const TimedQuantity& quantity) {
                                 const double before = quantity.by_odometry[delay - kBendOver];
                                 const double after = quantity.by_odometry[delay + kBendOver];
                                 return DelayedQuantity{0.5 * (after + before),
                                                        (after - before) / kApart_s,
                                                        quantity.sigma};
                               })
          .used(),
      kLogFactorSigma);
}

std::optional<TimingEvidence> TimingWindow::evidence() const {
  const std::size_t count = size();
  if (count < kFewestInWindow) return std::nullopt;
  TimingEvidence found;
  for (std::size_t i = 0; i < TimingDelays::kCount; ++i)
    found.errors[i] = error_at(i, true) + error_at(i, false);
  const auto best =
      static_cast<std::size_t>(std::ranges::min_element(found.errors) - found.errors.begin());
  if (best < kBendOver || best + kBendOver >= TimingDelays::kCount) return std::nullopt;
  const double over = static_cast<double>(kBendOver);
  const double before = found.errors[best - kBendOver];
  const double after = found.errors[best + kBendOver];
  const double bend = (before - 2.0 * found.errors[best] + after) / (over * over);
  const double information = information_at(best, true) + information_at(best, false);
  if (!(bend > 0.0) || !(information > 0.0)) return std::nullopt;
  found.usual_error = found.errors[best] / static_cast<double>(count);
  const double slope = (after - before) / (2.0 * over);
  found.timing.late_s = TimingDelays::at(best) - slope / bend * TimingDelays::kStep_s;
  found.timing.sigma_s =
      std::sqrt(std::max(found.usual_error, 1.0)) *
      std::max(TimingDelays::kStep_s * std::sqrt(2.0 / bend), 1.0 / std::sqrt(information));
  return found;
}

}  // namespace slammot::matching
