#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/sensing/aids.hpp"
#include "common/sensing/scan.hpp"

namespace slammot::sensing {

/// What was made of the readings of a gyro.
struct GyroUse {
  double read_s = 0.0;  ///< Duration of the steps of the wheels with readings.
  double used_s = 0.0;  ///< Of those whose turn is the gyro's.
  bool bias_is_known = false;
  double bias_radps = 0.0;
  double turn_ratio = 0.0;  ///< Turns by gyro over those by wheels; 0: hardly a turn yet.
};

/// Odometry whose way is that of the wheels and whose turns are those of a gyro, less its bias.
/// Wheels that slip in turns err by tenths of the turn, a gyro by thousandths of it and its bias.
///
/// The bias is measured against the wheels (random walk, scalar Kalman filter): while they stand
/// and on straights. What is left of it localization estimates from the scans, as the rate bias of
/// any odometry (motion_model.hpp). Steps without readings of the gyro keep the turn of the wheels,
/// and all do until the gyro has been seen to turn with the wheels: one that is mounted otherwise
/// or counts degrees does not.
class GyroOdometry {
 public:
  /// Readings in the order of their stamps; others are ignored.
  void add(const TurnRate& reading);

  /// The next sample of the wheels, with the gyro's turn. Before the first reading, the same
  /// sample. Readings up to the sample's stamp should have come; those that are missing are made up
  /// for with the next sample.
  Odometry fused(const Odometry& by_wheels);

  bool has_readings() const { return last_.has_value(); }
  GyroUse use() const;
  double bias_radps() const { return bias_radps_; }
  double bias_sigma_radps() const;

  /// Whether the bias is known, and turns by gyro and wheels agree in sign and size.
  bool is_believed() const;

 private:
  /// Integral of the readings up to a stamp.
  struct Turned {
    std::int64_t stamp_ns = 0;
    double turned_rad = 0.0;
  };
  struct Sample {
    Odometry by_wheels;
    Odometry fused;
    std::optional<double> turned_rad;
  };

  std::optional<double> turned_until(std::int64_t stamp_ns) const;
  double turn_of(const geometry::Pose2& by_wheels, double by_gyro_rad, double duration_s);
  void compare(double by_wheels_rad, double by_gyro_rad, double duration_s);
  void learn_bias(const geometry::Pose2& by_wheels, double by_gyro_rad, double duration_s);

  std::deque<Turned> turned_;
  std::optional<TurnRate> last_;
  std::optional<Sample> before_;
  double stood_s_ = 0.0;
  double read_s_ = 0.0;
  double used_s_ = 0.0;
  double gyro_by_wheels_ = 0.0;    ///< Sum of the products of both turn rates over time [rad^2/s],
  double wheels_by_wheels_ = 0.0;  ///< and of the squares of the wheels'.
  double bias_radps_ = 0.0;
  double bias_variance_ = 4e-4;  ///< (0.02 rad/s)^2: of a gyro that nobody calibrated.
};

}  // namespace slammot::sensing
