#pragma once

#include <array>
#include <cstddef>

namespace slammot::sensing {

/// Ratio of the way by scans to the way by odometry, as a discrete Bayes filter over comparisons of scans some way apart. One comparison has
/// several maxima where a street repeats itself; the true ratio is the one that they have in common.
class WayRatioFilter {
 public:
  static constexpr std::array kRatios{0.25, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.94, 0.97, 1.0, 1.03, 1.06, 1.1, 1.15, 1.2, 1.3, 1.5};
  using Profile = std::array<double, kRatios.size()>;

  WayRatioFilter();

  /// One comparison; log_likelihoods [nats], one a ratio, up to a constant.
  void update(const Profile& log_likelihoods);

  /// The profile without the straight line through it, since less of a place is new after less of the way; all zero where no ratio stands out
  /// by `least`: along a bare wall all ratios fit alike, and what is left is chance.
  static Profile prominent(Profile profile, double least);

  /// That odometry is right within 4 %.
  double sound_probability() const;

  double most_likely_ratio() const;

  /// Whether the weights are probabilities: not of a damaged checkpoint.
  bool is_sound() const;

 private:
  Profile weights_{};
};

}  // namespace slammot::sensing
