#include "common/matching/timing_window.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::matching {
namespace {

constexpr std::size_t kFewestInWindow = 5;
constexpr double kWorstSquared = 9.0;  // of one quantity; limits the effect of wrong matches
constexpr double kFactorPrior = 0.1;   // one sigma of the common factor of turns, and of ways: that
                                       // of a log is known before
constexpr std::size_t kBendOver = 2;   // delays to either side: there the errors are a parabola

double weight_of(const TimedQuantity& quantity) { return 1.0 / (quantity.sigma * quantity.sigma); }

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

template <typename Visitor>
void TimingWindow::visit(bool of_turns, Visitor visitor) const {
  for (std::size_t i = 0; i < kinds_.size(); ++i) {
    if (is_of_turn(static_cast<MotionChange>(i)) != of_turns) continue;
    for (std::size_t k = 0; k < kinds_[i].size(); ++k) visitor(kinds_[i].last[k]);
  }
}

/// Squared error with the common factor that fits best, as in odometry_timing().
double TimingWindow::error_at(std::size_t delay, bool of_turns) const {
  constexpr int kReweighings = 3;
  double factor = 1.0;
  double error = 0.0;
  for (int round = 0; round < kReweighings; ++round) {
    double weighted = 1.0 / (kFactorPrior * kFactorPrior);
    double information = weighted;
    error = 0.0;
    visit(of_turns, [&](const TimedQuantity& quantity) {
      const double by_odometry = quantity.by_odometry[delay];
      const double difference = (quantity.by_scans - factor * by_odometry) / quantity.sigma;
      error += std::min(difference * difference, kWorstSquared);
      if (difference * difference > kWorstSquared) return;
      weighted += weight_of(quantity) * by_odometry * quantity.by_scans;
      information += weight_of(quantity) * by_odometry * by_odometry;
    });
    factor = weighted / information;
  }
  return error;
}

/// About the delay [1/s^2], beyond what a common factor explains, as in odometry_timing().
double TimingWindow::information_at(std::size_t delay, bool of_turns) const {
  double by_delay = 0.0;
  double by_both = 0.0;
  double by_factor = 1.0 / (kFactorPrior * kFactorPrior);
  visit(of_turns, [&](const TimedQuantity& quantity) {
    const double before = quantity.by_odometry[delay - kBendOver];
    const double after = quantity.by_odometry[delay + kBendOver];
    const double change =
        (after - before) / (2.0 * static_cast<double>(kBendOver) * TimingDelays::kStep_s);
    const double middle = 0.5 * (after + before);
    by_delay += weight_of(quantity) * change * change;
    by_both += weight_of(quantity) * change * middle;
    by_factor += weight_of(quantity) * middle * middle;
  });
  return by_delay - by_both * by_both / by_factor;
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
