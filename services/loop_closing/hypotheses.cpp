#include "services/loop_closing/hypotheses.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Cholesky>

namespace slammot::loop_closing {
namespace {

using geometry::Matrix3;
using geometry::UncertainPose2;

constexpr double kClearlyWorse = 2.0;  // Greatest contradicted share of a hypothesis, as a multiple
                                       // of another one.
constexpr double kNoise_share = 0.01;  // Added to that limit.

double quality_of(const Hypothesis& hypothesis) { return hypothesis.quality(); }
double contradicted_share_of(const Hypothesis& hypothesis) {
  return 1.0 - hypothesis.agreement.agreed_share();
}

bool are_same(const UncertainPose2& a, const UncertainPose2& b) {
  const Eigen::Vector3d difference = geometry::difference(a.pose, b.pose);
  return difference.dot(Matrix3(a.covariance + b.covariance).ldlt().solve(difference)) <
         kSameWithinSquaredSigmas;
}

void drop_duplicates(std::vector<Hypothesis>& hypotheses) {
  std::stable_sort(
      hypotheses.begin(), hypotheses.end(),
      [](const Hypothesis& a, const Hypothesis& b) { return a.quality() > b.quality(); });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& hypothesis : hypotheses) {
    const bool is_known = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& one) {
      return are_same(one.from_to, hypothesis.from_to);
    });
    if (!is_known) kept.push_back(hypothesis);
  }
  hypotheses = std::move(kept);
}

void drop_contradicted(std::vector<Hypothesis>& hypotheses) {
  const std::vector<Hypothesis> all = hypotheses;
  std::erase_if(hypotheses, [&](const Hypothesis& one) {
    return std::ranges::any_of(
        all, [&](const Hypothesis& other) { return is_more_contradicted(one, other); });
  });
}

void drop_low_quality(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  if (hypotheses.empty()) return;
  const double least_quality = rival_ratio * hypotheses.front().quality();
  std::erase_if(hypotheses, [&](const Hypothesis& one) { return one.quality() < least_quality; });
  for (Hypothesis& hypothesis : hypotheses) hypothesis.has_rivals = hypotheses.size() > 1;
}

}  // namespace

bool is_more_contradicted(const Hypothesis& one, const Hypothesis& other) {
  constexpr double kComparableShare = 0.5;  // Least quality of the other hypothesis, as a share of
                                            // this one's.
  return contradicted_share_of(one) > kClearlyWorse * contradicted_share_of(other) + kNoise_share &&
         other.quality() > kComparableShare * one.quality();
}

void select_on_one_target(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  drop_duplicates(hypotheses);
  drop_contradicted(hypotheses);
  drop_low_quality(hypotheses, rival_ratio);
}

void drop_clearly_worse(std::vector<Hypothesis>& hypotheses, double rival_ratio) {
  const double best_quality = std::ranges::max(hypotheses, {}, quality_of).quality();
  std::erase_if(hypotheses,
                [&](const Hypothesis& one) { return one.quality() < rival_ratio * best_quality; });
  const double least_contradicted =
      contradicted_share_of(std::ranges::min(hypotheses, {}, contradicted_share_of));
  std::erase_if(hypotheses, [&](const Hypothesis& one) {
    return contradicted_share_of(one) > kClearlyWorse * least_contradicted + kNoise_share;
  });
}

}  // namespace slammot::loop_closing
