#pragma once

#include <optional>

#include "common/sensing/motion_model.hpp"
#include "common/sensing/odometry_belief.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/odometry_prediction.hpp"

namespace slammot::localization {

/// Whether steps are short enough, and time known, for a velocity to predict them.
bool has_velocity(const Step& step, const LocalizerConfig& config);

/// Usual time between scans without the value that its running mean begins with, which scans a
/// second apart outweigh only after many; before the first step that step's own duration.
double usual_duration_so_far_s(const Step& step, const sensing::OdometryBelief& belief,
                               const sensing::OdometryBeliefConfig& config);

/// The components of the mixture that predicts a step, beside odometry as calibrated: see
/// sensing::StepExplanation.
class StepExplanations {
 public:
  /// before: the estimate at the last scan. All must outlive this.
  StepExplanations(const sensing::MotionEstimate& before, const sensing::OdometryBelief& belief,
                   const LocalizerConfig& config, const sensing::MotionModelConfig& motion)
      : before_(before), belief_(belief), config_(config), motion_(motion) {}

  /// The same mean with a multiple of odometry's noise.
  Step rough(const Step& by_wheels) const;

  /// By the way and turn factors that matches suggest; none until they are known.
  std::optional<Step> recalibrated(const Step& by_wheels) const;

  /// Without odometry: at constant velocity, or, where scans are rare or time is not known,
  /// anywhere within reach.
  Step other(const Step& by_wheels) const;

  /// No odometry, and no velocity that could be extrapolated: on by half of the last step, and not
  /// known farther than a few usual ones.
  Step without_odometry(Step step) const;

  /// The same, but like the last step, straight on by as much as the usual one, or a turn on the
  /// spot: robots log a scan for each piece of way and each turn.
  Step like_the_last(const Step& step) const {
    return about(step, belief_.last_step, config_.belief.repeat_rad);
  }
  Step straight_on(const Step& step) const {
    return about(step, {belief_.usual_drive_m, 0.0, 0.0}, config_.belief.repeat_rad);
  }
  Step to_the_left(const Step& step) const {
    return about(step, {0.0, 0.0, belief_.usual_turn_rad}, 0.5 * belief_.usual_turn_rad);
  }
  Step to_the_right(const Step& step) const {
    return about(step, {0.0, 0.0, -belief_.usual_turn_rad}, 0.5 * belief_.usual_turn_rad);
  }

 private:
  Step about(Step step, const geometry::Pose2& before_from_base, double sigma_rad) const;
  Step at_constant_velocity(Step step) const;
  Step within_reach(Step step) const;

  const sensing::MotionEstimate& before_;
  const sensing::OdometryBelief& belief_;
  const LocalizerConfig& config_;
  const sensing::MotionModelConfig& motion_;
};

}  // namespace slammot::localization
