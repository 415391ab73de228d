#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace slammot::sensing {

/// Detects a sudden change of the speed that wheels count: the mean of the last steps is compared
/// with a straight line through the steps before them (constant acceleration). One step alone does
/// not tell it: noise of a step is taken back by the next one.
class WheelSpeedChange {
 public:
  /// One more step. Returns the change [m/s], or none where there is none or too few steps are
  /// known. After a change it begins anew.
  std::optional<double> observe(double speed_mps, double duration_s);

  /// Odometry was interrupted: earlier steps are forgotten.
  void begin_anew() { size_ = 0.0; }

  /// Passes each value of the state to the visitor, in a fixed order: for a checkpoint.
  template <typename Visitor>
  void visit(Visitor visit) const {
    visit(steps_), visit(size_);
  }
  template <typename Visitor>
  void visit(Visitor visit) {
    visit(steps_), visit(size_);
  }

  /// Whether a state that was read can have been one.
  bool is_sound() const;

 private:
  static constexpr std::size_t kLast = 3;     // steps whose mean is compared
  static constexpr std::size_t kBefore = 20;  // steps that the line goes through
  static constexpr std::size_t kMost = kBefore + kLast;

  struct Step {
    double middle_s = 0.0;  ///< Time of its middle before the end of the newest one, negative.
    double speed_mps = 0.0;
  };

  /// Straight line through the speeds of the first kBefore steps (least squares).
  struct Line {
    double middle_s = 0.0;
    double speed_mps = 0.0;  ///< At middle_s.
    double slope_mps2 = 0.0;
    double noise_m2ps2 = 0.0;  ///< Variance of the steps about it.

    double at(double time_s) const { return speed_mps + slope_mps2 * (time_s - middle_s); }
  };
  Line line_before() const;
  double departure_mps(const Step& step, const Line& line) const;
  std::optional<double> change_mps() const;

  std::array<Step, kMost> steps_{};  ///< Oldest first.
  double size_ = 0.0;                ///< How many are known, a whole number.
};

}  // namespace slammot::sensing
