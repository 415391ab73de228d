#pragma once

#include <algorithm>
#include <cmath>

namespace slammot::sensing {

/// Mean of innovations of one quantity over the last scans, about 60: of a filter that is right it
/// is near zero. Tells of errors that the filter's model does not have (Mehra 1972).
class MeanInnovation {
 public:
  /// sigmas: of one scan, by what was expected. error: of the quantity that is in doubt.
  void add(double sigmas, double error) {
    scans_ = std::min(scans_ + 1.0, kMost);
    const double gain = std::max(1.0 / scans_, kLeastGain);
    sigmas_ += gain * (sigmas - sigmas_);
    error_ += gain * (error - error_);
  }

  /// Square of the mean error where the mean is larger than noise of so many sigmas a scan
  /// explains: it then begins anew. 0 otherwise.
  double take_consistent(double noise_sigmas) {
    constexpr double kFewestScans = 5.0;
    if (scans_ < kFewestScans || std::abs(sigmas_) * std::sqrt(scans_) < noise_sigmas) return 0.0;
    const double squared_error = error_ * error_;
    *this = {};
    return squared_error;
  }

  /// Whether a state that was read can have been one.
  bool is_sound() const {
    return scans_ >= 0.0 && scans_ <= kMost && std::isfinite(sigmas_) &&
           std::abs(error_) < kLargest;
  }

 private:
  static constexpr double kMost = 66.0;       // as many scans as an exponential mean of this gain
  static constexpr double kLeastGain = 0.03;  // counts
  static constexpr double kLargest = 1e6;

  double scans_ = 0.0;
  double sigmas_ = 0.0;
  double error_ = 0.0;
};

}  // namespace slammot::sensing
