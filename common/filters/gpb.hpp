#pragma once

#include <Eigen/Core>

#include "common/filters/imm.hpp"
#include "common/filters/model_set.hpp"

namespace slammot::filters {

/// Generalized pseudo-Bayesian estimators (Wang 2004, Section 2.3; Tugnait 1982), a whole cycle as
/// one function: what tests hold imm_predict and imm_update with Mixture::kGpb1 and kGpb2 against,
/// by which tracking uses them. First order (GPB1) costs as much as the IMM and follows manoeuvres
/// worse. Second order (GPB2) follows them as well and runs a filter for each pair of models.

/// A measured position, time_s (>= 0) after the estimate that it corrects; R positive definite.
struct PositionFix {
  double after_s = 0.0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
};

/// One Gaussian for all histories, with the model probabilities.
struct Gpb1State {
  MotionState estimate;
  ModelWeights probability = {};
};

Gpb1State gpb1_start(const ModelSet& set, const MotionState& estimate);

/// One GPB1 cycle: every model starts from the one estimate, and all results are merged into one;
/// Wang 2004, Eq. (2.41).
Gpb1State gpb1_step(const ModelSet& set, const Gpb1State& state, const PositionFix& fix);

/// One GPB2 cycle: every model starts from every model's estimate, and results that end in the same
/// model are merged; Wang 2004, Eq. (2.42). State, initialization and combination are those of the
/// IMM.
ImmState gpb2_step(const ModelSet& set, const ImmState& state, const PositionFix& fix);

}  // namespace slammot::filters
