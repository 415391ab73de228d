#pragma once

#include <array>
#include <cstddef>

#include "common/matching/point_to_line.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "services/localization/step_to_explain.hpp"

namespace slammot::localization {

/// By explanation; minus infinity for one that is not in the mixture.
using LogLikelihoods = std::array<double, sensing::kStepExplanations>;

/// Of the registration under the prediction of a step.
double log_likelihood_of(const Step& step, const geometry::Pose2& optimum,
                         const matching::PointToLineResult& registered);

/// What is known of a pose before the scan is said of it: without odometry that steps repeat, with
/// it what each explanation predicts.
LogLikelihoods log_priors(const StepToExplain& scan, const geometry::Pose2& optimum,
                          const matching::PointToLineResult& registered);

/// Of the explanations that are one and the same to sensing, the one whose prediction is nearest to
/// the pose.
std::size_t likeliest_step(const StepToExplain& scan, std::size_t explanation,
                           const geometry::Pose2& optimum,
                           const matching::PointToLineResult& registered);

}  // namespace slammot::localization
