#pragma once

#include <array>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/filters/gaussian.hpp"
#include "common/filters/model_set.hpp"

namespace slammot::filters {

/// Estimate of an object that switches between motion models. The functions below work for each
/// Mixture of the model set; the IMM is the default.

/// One estimate a model, with the model probabilities.
struct ImmState {
  std::array<MotionState, kMaxModels> modes;
  ModelWeights probability = {};
  /// Of GPB2, between prediction and update: estimates and probabilities of all pairs of models,
  /// at index to * size + from. Empty otherwise. Unlike the rest it allocates.
  std::vector<MotionState> pairs;
  std::vector<double> pair_probability;
};

struct ImmUpdate {
  ImmState posterior;
  double log_likelihood = 0.0;  ///< Of the measurement under the mixture.
};

/// Initializes every model with the same estimate; all models are equally probable.
ImmState imm_start(const ModelSet& set, const MotionState& estimate);

/// Mixing (Wang 2004, Eqs. 2.49-2.51) and mode-matched prediction over time_s >= 0. GPB1 mixes all
/// models into one estimate; GPB2 predicts all pairs, which the update merges. Switching
/// probabilities follow from the time and the mean stay, not from the number of scans. The model
/// set may differ from that of the step before if one is a prefix of the other (variable structure:
/// Li and Bar-Shalom 1996). A new model gets its probability by switches; the last remaining model
/// takes over that of removed models.
ImmState imm_predict(const ModelSet& set, const ImmState& state, double time_s);

/// Innovation of a measured position (covariance R, positive definite) against the combined
/// prediction.
Innovation<2> imm_innovation(const ModelSet& set, const ImmState& predicted,
                             const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R);

/// Mode-matched update with a measured position (covariance R, positive definite), and update of
/// the model probabilities; Wang 2004, Eqs. (2.46)-(2.47). Of GPB2: of all pairs, merged by the
/// model in which they end, Eq. (2.42).
ImmUpdate imm_update(const ModelSet& set, const ImmState& predicted,
                     const Eigen::Vector2d& position_m, const Eigen::Matrix2d& R);

/// Mode-matched update with a velocity component: direction (unit length) times velocity measures
/// speed_mps, with variance > 0 [(m/s)^2]. Model probabilities do not change: the measurement
/// informs on direction, not on the manoeuvre.
ImmState imm_update_speed(const ModelSet& set, const ImmState& predicted,
                          const Eigen::Vector2d& direction, double speed_mps, double variance);

/// Moment-matched mean and covariance of the mixture; Wang 2004, Eqs. (2.52)-(2.53).
MotionState imm_combine(const ModelSet& set, const ImmState& state);

/// Fills the path with mean and covariance of the mixture's predicted position after step_s, 2
/// step_s, ... without measurements. Each step mixes and predicts as imm_predict does, so that a
/// manoeuvre may continue or end.
void imm_foretell(const ModelSet& set, const ImmState& state, double step_s,
                  std::span<Gaussian<2>> path);

/// Shifts every mode's position by a known offset: a change of the reference point.
void imm_shift(const ModelSet& set, ImmState& state, const Eigen::Vector2d& shift_m);

/// The same with an uncertain offset of this covariance. The shift is not motion: velocities do not
/// change.
void imm_loosen(const ModelSet& set, ImmState& state, const Eigen::Matrix2d& covariance_m2);

/// Adds white acceleration over time_s >= 0, beside the process noise of the models. density: of
/// its power spectrum, positive semidefinite [m^2/s^3].
void imm_add_acceleration_noise(const ModelSet& set, ImmState& state,
                                const Eigen::Matrix2d& density, double time_s);

}  // namespace slammot::filters
