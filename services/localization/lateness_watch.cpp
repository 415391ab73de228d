#include "services/localization/lateness_watch.hpp"

#include <algorithm>
#include <cmath>

namespace slammot::localization {
namespace {

using geometry::Pose2;
using matching::TimingDelays;

constexpr double kTimingReach_m = 40.0;                 // half side of what is kept of a scan
constexpr double kMostTimingEchoes = 1000.0;            // weight limit: more than a scan has
constexpr std::size_t kOdometryKept = 1024;             // samples
constexpr std::int64_t kThinned_ns = 8'000'000;         // between samples: 8 s are kept
constexpr std::int64_t kDenseOdometry_ns = 80'000'000;  // longer gaps: a car does not turn evenly
                                                        // between
constexpr std::int64_t kDelayReach_ns = 420'000'000;    // TimingDelays::kReach_s and a sample
constexpr double kPairPrior_m = 0.3;  // prior of a registration, about the estimate
constexpr double kPairPrior_rad = 0.06;
constexpr double kPairMatchedShare = 0.5;
constexpr double kStraightPair_rad = 0.05;  // else the way depends on the point of the vehicle
constexpr double kKnownPair_m = 0.05;       // one sigma
constexpr double kKnownPair_rad = 0.01;
constexpr double kPairFloor_m = 0.014;  // one sigma of two scans
constexpr double kPairFloor_rad = 0.002;
constexpr double kLeastLateness_s = 0.012;  // less is estimated by the filter
constexpr double kLatenessSigmas = 5.0;
constexpr double kRoughLateness_s = 0.02;  // one sigma
constexpr double kKnownLateness_s = 0.01;
constexpr double kRefinedSigmas = 3.0;
constexpr double kRefutedSigmas = 6.0;  // of no lateness, by the curve of errors,
constexpr double kRoughSigmas = 2.0;    // and of the lateness itself, then

double timed_quantity_of(const Pose2& motion, matching::MotionChange change) {
  return matching::is_of_turn(change) ? motion.heading_rad : motion.translation_m().norm();
}

}  // namespace

LatenessWatch::LatenessWatch(const LocalizerConfig& config)
    : match_(config.match),
      surfels_(grids::window_around(geometry::Vector2::Zero(), 2.0 * kTimingReach_m,
                                    config.map.surfel_size_m),
               kMostTimingEchoes),
      odometry_(kOdometryKept) {
  match_.unproven_share = 1.0;
  match_.proven_after_m = 0.0;
  match_.new_below_m = 0.0;
  match_.information_share = 1.0;
}

void LatenessWatch::add(const sensing::Odometry& sample) {
  if (newest_odometry_ns_ && sample.stamp_ns < *newest_odometry_ns_ + kThinned_ns) return;
  newest_odometry_ns_ = sample.stamp_ns;
  odometry_.add(sample);
}

std::optional<matching::OdometryTiming> LatenessWatch::observe(const Seen& seen, double in_use_s) {
  if (scanner_id_.empty()) scanner_id_ = seen.scanner_id;
  if (seen.scanner_id != scanner_id_) return std::nullopt;
  scans_.add(seen.stamp_ns, seen.wheel_from_base, seen.odom_from_base, seen.points);
  register_next();
  if (!compare_next()) return std::nullopt;
  const auto found = window_.evidence();
  if (!found || !is_clear(*found, in_use_s)) return std::nullopt;
  last_found_s_ = found->timing.late_s;
  return found->timing;
}

/// Where odometry seems sound much is needed to doubt it: either the lateness is known well, or few
/// pairs say clearly that it is not zero, and roughly what it is. A lateness that was found is
/// refined, or taken back, sooner.
bool LatenessWatch::is_clear(const matching::TimingEvidence& found, double in_use_s) const {
  const double believed_s = last_found_s_.value_or(in_use_s);
  const double off_s = std::abs(found.timing.late_s - believed_s);
  const double sigma_s = found.timing.sigma_s;
  const double gain = found.gain_over(believed_s);
  if (off_s < kLeastLateness_s) return false;
  if (last_found_s_)
    return sigma_s < kKnownLateness_s && off_s > kRefinedSigmas * sigma_s &&
           gain > kRefinedSigmas * kRefinedSigmas;
  const bool is_known = sigma_s < kRoughLateness_s && off_s > kLatenessSigmas * sigma_s &&
                        gain > kLatenessSigmas * kLatenessSigmas;
  const bool is_rough = off_s > kRoughSigmas * sigma_s && gain > kRefutedSigmas * kRefutedSigmas;
  return is_known || is_rough;
}

void LatenessWatch::register_next() {
  const auto pair = scans_.take();
  if (!pair || waiting_count_ == kMostWaiting) return;
  surfels_.clear();
  for (const matching::MatchPoint& point : pair->first.points) surfels_.add(point.in_base_m);
  const geometry::UncertainPose2 prior{
      geometry::inverse(pair->first.odom_from_base) * pair->second.odom_from_base,
      Eigen::Vector3d(kPairPrior_m, kPairPrior_m, kPairPrior_rad).cwiseAbs2().asDiagonal()};
  const matching::PointToLineResult found =
      matcher_.match(pair->second.points, surfels_, prior, prior.pose, match_);
  if (found.matched_share < kPairMatchedShare) return;
  const auto& [motion, covariance] = found.map_from_base;
  double sigma = 0.0;
  if (matching::is_of_turn(pair->change)) {
    sigma = std::sqrt(covariance(2, 2));
    if (sigma > kKnownPair_rad) return;
    sigma = std::hypot(sigma, kPairFloor_rad);
  } else {
    const double way_m = motion.translation_m().norm();
    if (way_m <= 0.0 || std::abs(motion.heading_rad) > kStraightPair_rad) return;
    const geometry::Vector2 along = motion.translation_m() / way_m;
    sigma = std::sqrt(along.dot(covariance.topLeftCorner<2, 2>() * along));
    if (sigma > kKnownPair_m) return;
    sigma = std::hypot(sigma, kPairFloor_m);
  }
  waiting_[(first_waiting_ + waiting_count_++) % kMostWaiting] = {
      pair->first.stamp_ns,
      pair->second.stamp_ns,
      {.change = pair->change,
       .by_scans = timed_quantity_of(motion, pair->change),
       .sigma = sigma,
       .by_odometry = {}}};
}

std::optional<Pose2> LatenessWatch::by_odometry(const Registered& pair, double delay_s) const {
  const auto delay_ns = static_cast<std::int64_t>(std::llround(delay_s * 1e9));
  const auto first = odometry_.wheel_from_base_at(pair.first_ns + delay_ns);
  const auto second = odometry_.wheel_from_base_at(pair.second_ns + delay_ns);
  if (!first || !second) return std::nullopt;
  return geometry::inverse(*first) * *second;
}

bool LatenessWatch::is_covered(const Registered& pair) const {
  return odometry_.is_dense(pair.first_ns - kDelayReach_ns, pair.second_ns + kDelayReach_ns,
                            kDenseOdometry_ns);
}

/// False where no pair was added to the window.
bool LatenessWatch::compare_next() {
  if (waiting_count_ == 0) return false;
  Registered& pair = waiting_[first_waiting_];
  if (!odometry_.reaches(pair.second_ns + kDelayReach_ns)) return false;
  first_waiting_ = (first_waiting_ + 1) % kMostWaiting;
  --waiting_count_;
  if (!is_covered(pair)) return false;
  for (std::size_t i = 0; i < TimingDelays::kCount; ++i) {
    const auto motion = by_odometry(pair, TimingDelays::at(i));
    if (!motion) return false;
    pair.quantity.by_odometry[i] =
        static_cast<float>(timed_quantity_of(*motion, pair.quantity.change));
  }
  window_.add(pair.quantity);
  return true;
}

}  // namespace slammot::localization
