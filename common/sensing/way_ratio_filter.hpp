#pragma once

#include <array>
#include <cstddef>

namespace slammot::sensing {

/// Discrete Bayes filter of the ratio of way by scans to way by odometry, over comparisons of scans
/// some way apart. On repetitive streets one comparison has several maxima; the true ratio is
/// common to all comparisons.
class WayRatioFilter {
 public:
  static constexpr std::array kRatios{0.25, 0.5, 0.6,  0.7,  0.75, 0.8,  0.85, 0.9, 0.94,
                                      0.97, 1.0, 1.03, 1.06, 1.1,  1.15, 1.2,  1.3, 1.5};
  using Profile = std::array<double, kRatios.size()>;

  WayRatioFilter();

  /// Updates with one comparison; log_likelihoods [nats], one a ratio, up to a constant.
  void update(const Profile& log_likelihoods);

  /// The ratio may have become any other one: even odds for that.
  void doubt();

  /// The profile minus its linear trend, because after less way less of the place is new. All zero
  /// unless one ratio exceeds the others by `least`: along a bare wall all ratios fit equally and
  /// the rest is noise. All zero, too, where the least ratio exceeds the others, since traffic
  /// that moves along fits with no way at all, or the largest does by the trend alone, which such
  /// traffic bends.
  static Profile prominent(Profile profile, double least);

  /// Probability that odometry is correct within 4 %.
  double sound_probability() const;

  double most_likely_ratio() const;

  /// True if the weights are probabilities; false after a damaged checkpoint.
  bool is_sound() const;

 private:
  Profile weights_{};
};

}  // namespace slammot::sensing
