#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "services/localization/localizer.hpp"

/// What the localizer does when scans do not fit the map where it believes to be: the vehicle was carried away, or has not
/// seen anything for long. Three levels, each wider than the one before: the local map, a map of its own, and all stored
/// submaps, which is loop closing's.
namespace slammot::localization {
namespace {

using geometry::UncertainPose2;

constexpr double kWindowPerScan_m = 2.0;       // the longer it is lost, the wider it looks
constexpr unsigned kScansBetweenWideSearches = 16;
constexpr std::size_t kPointsPerProbe = 4;     // neighbours end on the same thing
constexpr std::size_t kPoses = 4;              // that are looked at
constexpr double kLeastPeakRatio = 0.7;
constexpr int kFewestProbes = 10;
constexpr double kSeenThroughWalls_share = 0.1;
constexpr double kChanged_share = 0.5;         // of what was explained one scan before
constexpr double kThroughAWall_m = 1.0;        // grazing beams meet the cells before the one that they end in
constexpr double kRivalRatio = 0.98;           // with another pose that is as good as this it waits for a scan that tells
constexpr std::int32_t kShortSubmaps = 4;      // loop closing needs two or three that agree
constexpr double kFoundByHalf = 0.5;           // what it was lost by must have fallen to this share where it is found

/// A wide search costs as much as hundreds of matches.
bool is_worth_a_search(unsigned lost_scans) { return std::has_single_bit(lost_scans) || lost_scans % kScansBetweenWideSearches == 0; }

bool are_same(const geometry::Pose2& a, const geometry::Pose2& b) {
  constexpr double kSame_m = 0.3;
  constexpr double kSame_rad = 0.1;
  const Eigen::Vector3d apart = geometry::difference(a, b);
  return apart.head<2>().norm() < kSame_m && std::abs(apart.z()) < kSame_rad;
}

bool is_same_view(const geometry::Pose2& before_from_now) {
  constexpr double kSameView_m = 1.0;
  constexpr double kSameView_rad = 0.2;
  return before_from_now.translation_m().norm() < kSameView_m && std::abs(before_from_now.heading_rad) < kSameView_rad;
}

}  // namespace

matching::CorrelativeConfig Localizer::finder_config(matching::CorrelativeConfig search) {
  search.max_peaks = kPoses;
  search.min_peak_ratio = kLeastPeakRatio;
  return search;
}

ScanMatch Localizer::match_or_find(const Step& step, const sensing::LaserScan& scan) {
  const bool has_wheels = step.is_by_wheels();
  progress_.contradicts_map = false;
  ScanMatch found = match(step, scan.sequence);
  const bool is_contradicting = is_contradicted(found, step);
  found.is_lost |= is_contradicting;
  if (found.is_lost && config_.recovers) {
    if (!progress_.lost_since_ns) progress_.lost_since_ns = scan.stamp_ns;
    progress_.scans_to_prove = config_.found_scans + 1;
    const double lost_s = static_cast<double>(scan.stamp_ns - *progress_.lost_since_ns) * 1e-9;
    progress_.contradicts_map = is_contradicting;
    // Traffic on all sides hides the map for as long as it likes: what drives and was not seen to be moved trusts its wheels.
    const bool trusts_wheels = has_wheels && !progress_.everything_changed && !config_.may_be_picked_up;
    const bool is_patient = trusts_wheels || (has_wheels && lost_s < config_.lost_after_s);
    if (is_patient) return found;
    ++progress_.lost_scans;
    drop_doubted();
    if (const auto again = find_again(step)) found = *again;
  }
  if (!found.is_believed || found.is_lost) return found;
  // In a wrong place a scan or two may fit: that is no end of being lost.
  if (progress_.scans_to_prove > 0 && --progress_.scans_to_prove > 0) return found;
  progress_.lost_since_ns.reset();
  progress_.lost_scans = 0;
  integrate_doubted();
  return found;
}

/// It was there all the time: the scanner saw the ground, or traffic on all sides.
void Localizer::integrate_doubted() {
  for (PendingScan& scan : doubted_) integrate(scan);
  doubted_.clear();
}

void Localizer::drop_doubted() {
  progress_.counters.withheld_scans += doubted_.size();
  doubted_.clear();
}

/// Where the prediction is sure, much that contradicts the map is traffic; where it is not, the match may be anywhere. But
/// traffic stands before walls, and does not come from one scan to the next. Where the vehicle has hardly moved, nothing does
/// but the ground that a braking scanner sees, and another place.
bool Localizer::is_contradicted(const ScanMatch& found, const Step& step) {
  const UncertainPose2 prior = step.prior();
  const bool has_wheels = step.is_by_wheels();
  if (!found.is_believed && !found.is_lost) {
    progress_.explained_before = 0.0;  // beams without echo have cleared the map meanwhile: nothing is to be concluded from that
    return false;
  }
  const geometry::Pose2& pose = found.odom_from_base.pose;
  const bool may_be_elsewhere = !has_wheels || config_.may_be_picked_up;
  if (!may_be_elsewhere && !progress_.everything_changed) {
    progress_.explained_before.reset();  // the map is not asked as long as nobody wants to know: it may still be taking in the last scan
    return false;
  }
  const double before = progress_.explained_before ? *progress_.explained_before : explained_share(match_points_before_, prediction_.estimate().odom_from_base);
  const double explained = explained_share(match_points_, pose);
  if (!progress_.lost_since_ns) progress_.everything_changed = may_be_elsewhere && before - explained > kChanged_share && is_same_view(geometry::inverse(prediction_.estimate().odom_from_base) * prior.pose);
  progress_.explained_before = explained;
  if (!may_be_elsewhere && !progress_.everything_changed) return false;
  if (found.is_lost && progress_.everything_changed) return true;
  if (is_vague(prior)) return contradiction(pose).share() > config_.most_contradicted_share;
  if (progress_.lost_since_ns && progress_.everything_changed) return contradiction(pose).share() > kFoundByHalf * config_.most_contradicted_share;
  if (!found.is_lost && !progress_.lost_since_ns && explained >= 1.0 - config_.most_contradicted_when_sure) return false;
  const double most = found.is_lost || progress_.lost_since_ns ? config_.most_contradicted_share : config_.most_contradicted_when_sure;
  const Contradiction there = contradiction(pose);
  return there.share() > most && (progress_.everything_changed || there.share_behind_walls() > kSeenThroughWalls_share);
}

/// Of the points, how many lie on what the map knows: cheap, and enough to see that all is well. Of none, none.
double Localizer::explained_share(const std::vector<matching::MatchPoint>& points, const geometry::Pose2& odom_from_base) const {
  const grids::EvidenceGrid& evidence = map_.evidence();
  const int tolerance = static_cast<int>(std::ceil(config_.map.end_cell_tolerance_m / config_.map.cell_size_m - 0.5));
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  int explained = 0;
  int probes = 0;
  for (std::size_t i = 0; i < points.size(); i += kPointsPerProbe, ++probes) {
    const geometry::Vector2 at_m = odom_from_base.translation_m() + turn * points[i].in_base_m;
    if (evidence.is_occupied_near(evidence.window().cell_at(at_m.x(), at_m.y()), tolerance)) ++explained;
  }
  return probes == 0 ? 0.0 : static_cast<double>(explained) / probes;
}

Localizer::Contradiction Localizer::contradiction(const geometry::Pose2& odom_from_base) const {
  const grids::EvidenceGrid& evidence = map_.evidence();
  const int free_steps = grids::steps_of_log_odds(config_.map.free_log_odds);
  const int tolerance = static_cast<int>(std::ceil(config_.map.end_cell_tolerance_m / config_.map.cell_size_m - 0.5));
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  const geometry::Vector2 origin_m = odom_from_base * laser_in_base_m_;
  Contradiction found;
  for (std::size_t i = 0; i < match_points_.size(); i += kPointsPerProbe) {
    const geometry::Vector2 at_m = odom_from_base.translation_m() + turn * match_points_[i].in_base_m;
    const grids::Cell cell = evidence.window().cell_at(at_m.x(), at_m.y());
    const double range_m = (at_m - origin_m).norm();
    const bool is_behind_a_wall =
        range_m > kThroughAWall_m && evidence.distance_to_occupied(origin_m, (at_m - origin_m) / range_m, range_m) < range_m - kThroughAWall_m;
    const bool is_explained = evidence.is_occupied_near(cell, tolerance);
    if (is_behind_a_wall) ++found.behind_walls;
    else if (!is_explained && evidence.so_steps(cell) <= -free_steps) ++found.in_free_space;
    else if (is_explained) ++found.explained;
  }
  return found;
}

double Localizer::Contradiction::share_of_known(int points) const {
  const int known = behind_walls + in_free_space + explained;
  return known < kFewestProbes ? 0.0 : static_cast<double>(points) / known;
}

/// Whichever way it looks now: a room looks much the same from both of its ends, and only all the answers together tell.
std::optional<ScanMatch> Localizer::find_again(const Step& step) {
  if (!is_worth_a_search(static_cast<unsigned>(progress_.lost_scans))) return std::nullopt;
  const double sigma_m = std::min(kWindowPerScan_m * progress_.lost_scans, config_.search_reach_m) / config_.search_sigmas;
  const matching::PointToLineConfig& config = match_config(step.source);
  UncertainPose2 anywhere = step.prior();
  anywhere.covariance.diagonal() += Eigen::Vector3d(sigma_m, sigma_m, std::numbers::pi).cwiseAbs2();
  std::optional<ScanMatch> best;
  double best_quality = 0.0;
  double rival_quality = 0.0;
  for (const matching::Peak& peak : peaks_around(anywhere, finder_)) {
    const UncertainPose2 about_peak{peak.target_from_source.pose, anywhere.covariance};
    const matching::PointToLineResult result = matcher_.match(match_points_, map_.surfels(), about_peak, peak.target_from_source.pose, config);
    const double contradicted = contradiction(result.map_from_base.pose).share();
    if (result.matched_share < config_.found_share || contradicted > kFoundByHalf * config_.most_contradicted_share) continue;
    const double quality = result.matched_share * (1.0 - contradicted);
    const bool is_best = quality > best_quality;
    const bool is_same = best && are_same(best->odom_from_base.pose, result.map_from_base.pose);
    if (!is_same) rival_quality = std::max(rival_quality, std::min(quality, best_quality));
    if (!is_best) continue;
    best = ScanMatch{.odom_from_base = result.map_from_base, .is_believed = true, .rms_residual_m = result.rms_residual_m};
    best_quality = quality;
  }
  if (!best || rival_quality > kRivalRatio * best_quality) return std::nullopt;
  ++progress_.counters.found_again;
  return best;
}

bool Localizer::has_gone_astray(std::int64_t stamp_ns) const {
  return progress_.lost_since_ns && progress_.lost_scans > 0 && static_cast<double>(stamp_ns - *progress_.lost_since_ns) * 1e-9 > config_.lost_after_s + config_.astray_after_s;
}

UncertainPose2 Localizer::anywhere_about(const geometry::Pose2& pose) const {
  const double sigma_m2 = config_.astray_sigma_m * config_.astray_sigma_m;
  return {pose, Eigen::Vector3d(sigma_m2, sigma_m2, std::numbers::pi * std::numbers::pi).asDiagonal()};
}

void Localizer::go_on_after(const flow::CorrectedSubmap& last) {
  if (prediction_.last()) return;
  first_submap_ = {last.submap_id.value + 1};
  map_from_odom_ = last.map_from_submap;
  previous_from_submap_ = anywhere_about(geometry::Pose2::identity());
  short_submaps_left_ = kShortSubmaps;
}

/// Nothing that was seen before is of use here: the map begins with this scan, and the pose against it is exact.
void Localizer::begin_astray_submap() {
  ++progress_.counters.astray;
  const geometry::Pose2 odom_from_previous = map_.odom_from_submap();
  if (!submap_is_ended_ && map_.has_echoes()) end_submap();
  map_.begin_astray(prediction_.estimate().odom_from_base.translation_m());
  previous_from_submap_ = anywhere_about(geometry::inverse(odom_from_previous) * map_.odom_from_submap());
  progress_.drift.setZero();
  progress_.travelled_m = 0.0;
  submap_is_ended_ = false;
  short_submaps_left_ = kShortSubmaps;
  prediction_.begin_map_here();
  progress_.lost_since_ns.reset();
  progress_.lost_scans = 0;
  progress_.scans_to_prove = 0;
  progress_.contradicts_map = false;
  drop_doubted();
}

}  // namespace slammot::localization
