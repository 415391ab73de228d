#include "common/graphs/fix_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/LU>

#include "common/filters/gaussian.hpp"

namespace slammot::graphs {
namespace {

using geometry::Matrix2;
using geometry::Matrix3;
using geometry::Pose2;
using geometry::Vector2;
using Sensitivity = Eigen::Matrix<double, 2, 3>;  // by the pose

constexpr double kLastingAtFirst = 0.3;  // probability
constexpr double kJumps = 0.3;           // of the ends of a stretch: another offset follows

/// Error of the newest fix beyond its covariance, in one regime.
struct Regime {
  double probability = 0.0;
  Vector2 mean_m = Vector2::Zero();
  Matrix2 covariance_m2 = Matrix2::Zero();
  Sensitivity by_pose = Sensitivity::Zero();  ///< Of the mean.
};

/// Usual, lasting.
using Regimes = std::array<Regime, 2>;

/// Ways from a regime into a regime, before a fix is known: usual from usual and from lasting,
/// lasting from itself, from usual and by a jump.
using Transitions = std::array<Regime, 5>;
constexpr std::size_t kUsualTransitions = 2;

Matrix2 isotropic(double variance) { return variance * Matrix2::Identity(); }

Regime fresh(double probability, double sigma_m) {
  return {probability, Vector2::Zero(), isotropic(sigma_m * sigma_m), Sensitivity::Zero()};
}

Transitions transitions_of(const Regimes& regimes, double way_m, const FixErrorModel& model) {
  const auto& [usual, lasting] = regimes;
  const double begins = -std::expm1(-way_m / model.lasting_after_m);
  const double ends = -std::expm1(-way_m / model.lasting_for_m);
  const double usual_m2 = model.usual_sigma_m * model.usual_sigma_m;
  const double kept = std::exp(-way_m / model.usual_length_m);
  Regime drifted = usual;
  drifted.probability *= 1.0 - begins;
  drifted.mean_m *= kept;
  drifted.by_pose *= kept;
  drifted.covariance_m2 =
      kept * kept * usual.covariance_m2 + isotropic(usual_m2 * (1.0 - kept * kept));
  Regime walked = lasting;
  walked.probability *= 1.0 - ends;
  walked.covariance_m2 += isotropic(2.0 * usual_m2 * way_m / model.usual_length_m);
  return {drifted, fresh(lasting.probability * ends * (1.0 - kJumps), model.usual_sigma_m), walked,
          fresh(usual.probability * begins, model.lasting_sigma_m),
          fresh(lasting.probability * ends * kJumps, model.lasting_sigma_m)};
}

/// Mixture with its moments.
Regime mixed(std::span<const Regime> parts) {
  Regime mean;
  for (const Regime& part : parts) {
    mean.probability += part.probability;
    mean.mean_m += part.probability * part.mean_m;
    mean.by_pose += part.probability * part.by_pose;
  }
  if (mean.probability <= 0.0) return parts.front();
  mean.mean_m /= mean.probability;
  mean.by_pose /= mean.probability;
  for (const Regime& part : parts) {
    const Vector2 away_m = part.mean_m - mean.mean_m;
    mean.covariance_m2 +=
        part.probability / mean.probability * (part.covariance_m2 + away_m * away_m.transpose());
  }
  return mean;
}

/// Conditions a transition on the error of a fix; adds its share to gradient and information.
struct Updated {
  Regime regime;
  double log_likelihood = 0.0;
  Eigen::Vector3d gradient;
  Matrix3 information;
};

Updated updated(const Regime& before, const Vector2& error_m, const Sensitivity& error_by_pose,
                const Matrix2& noise_m2) {
  const Matrix2 S = before.covariance_m2 + noise_m2;
  const auto innovation = filters::innovation<2>(error_m - before.mean_m, S);
  const Sensitivity by_pose = error_by_pose - before.by_pose;
  const Matrix2 S_inverse = S.inverse();
  const Matrix2 K = before.covariance_m2 * S_inverse;
  Updated after;
  after.regime = {before.probability, before.mean_m + K * innovation.residual,
                  (Matrix2::Identity() - K) * before.covariance_m2, before.by_pose + K * by_pose};
  after.log_likelihood = innovation.log_likelihood;
  after.gradient = -by_pose.transpose() * S_inverse * innovation.residual;
  after.information = by_pose.transpose() * S_inverse * by_pose;
  return after;
}

Regimes regimes_at_first(const FixErrorModel& model) {
  return {fresh(1.0 - kLastingAtFirst, model.usual_sigma_m),
          fresh(kLastingAtFirst, model.lasting_sigma_m)};
}

/// Takes one fix; `total` gains its share.
Regimes next(const Regimes& regimes, const Fix& fix, const Pose2& enu_from_map,
             const FixErrorModel& model, FixLikelihood& total) {
  const Vector2 arm_m = geometry::rotation(enu_from_map.heading_rad) * fix.in_map_m;
  Sensitivity by_pose;
  by_pose << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
  const Vector2 error_m = enu_from_map.translation_m() + arm_m - fix.in_enu_m;
  const Transitions before = transitions_of(regimes, fix.way_m, model);
  std::array<Updated, std::tuple_size_v<Transitions>> after;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < before.size(); ++i) {
    after[i] = updated(before[i], error_m, by_pose, fix.covariance_m2);
    if (before[i].probability > 0.0) most = std::max(most, after[i].log_likelihood);
  }
  double sum = 0.0;
  for (Updated& part : after) {
    part.regime.probability *= std::exp(std::min(0.0, part.log_likelihood - most));
    sum += part.regime.probability;
  }
  total.logarithm += most + std::log(sum);
  Transitions parts;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts[i] = after[i].regime;
    parts[i].probability /= sum;
    total.gradient += parts[i].probability * after[i].gradient;
    total.information += parts[i].probability * after[i].information;
  }
  const std::span<const Regime> all = parts;
  return {mixed(all.first(kUsualTransitions)), mixed(all.subspan(kUsualTransitions))};
}

}  // namespace

FixLikelihood likelihood(std::span<const Fix> fixes, const Pose2& enu_from_map,
                         const FixErrorModel& model) {
  FixLikelihood total;
  Regimes regimes = regimes_at_first(model);
  for (const Fix& fix : fixes) regimes = next(regimes, fix, enu_from_map, model, total);
  return total;
}

}  // namespace slammot::graphs
