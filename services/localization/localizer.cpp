#include "services/localization/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "common/sensing/turning_direction.hpp"

namespace slammot::localization {
namespace {

using flow::EndCell;
using flow::PointLabel;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

constexpr double kNanosecond_s = 1e-9;
constexpr std::uint64_t kCheckpointMark = 0x736c616d6d6f7462;  // "slammota": the last digit, hexadecimal, counts the forms of a checkpoint
constexpr double kShorterBy = 2.5;  // where it is not known where they lie, two are sooner there to be searched for
constexpr double kFastestRestored = 1e3;    // m/s or rad/s: no vehicle was faster when the checkpoint was made
constexpr double kFarthestStamp_ns = 4e18;  // 126 years: differences of stamps do not overflow
constexpr double kLongestExpectation_s = 1.0;  // tracking that has been silent for longer expects nothing any more

constexpr double kCoarsePriorSigmas = 2.0;  // without wheels: so far off is a prediction while the vehicle begins to turn
/// Whether it may have been one of ours.
bool is_believable(const sensing::MotionEstimate& estimate) {
  return localization::is_believable(estimate.odom_from_base) && localization::is_believable(estimate.covariance) &&
         estimate.calibration.norm() < 1.0 && estimate.velocity.norm() < kFastestRestored;
}

/// Where the object is so long after it was published, in odom.
grids::Box box_of(const flow::TrackedObject& object, double after_s, double margin_m) {
  return {object.position_in_odom_m + after_s * object.velocity_in_odom_mps, {std::cos(object.heading_in_odom_rad), std::sin(object.heading_in_odom_rad)},
          {0.5 * object.length_m + margin_m, 0.5 * object.width_m + margin_m}};
}

/// Whether a vehicle is seen in the scan of this stamp, has been known for a while, and is surely not at rest.
bool is_surely_moving_vehicle(const flow::TrackedObject& object, std::int64_t stamp_ns) {
  constexpr double kLeastSpeedMps = 1.0;
  constexpr double kSigmas = 3.0;
  constexpr double kLeastKnownS = 0.5;
  constexpr double kShortestVehicleM = 1.5;
  if (!object.confirmed || object.last_seen_ns != stamp_ns || object.length_m < kShortestVehicleM) return false;
  const double speed_mps = object.velocity_in_odom_mps.norm();
  const double sigma_mps = std::sqrt(object.covariance.bottomRightCorner<2, 2>().trace());
  return speed_mps >= std::max(kLeastSpeedMps, kSigmas * sigma_mps) && static_cast<double>(stamp_ns - object.first_seen_ns) * kNanosecond_s >= kLeastKnownS;
}

/// What a point does to the maps.
grids::Echo echo_of(PointLabel label) {
  switch (label) {
    case PointLabel::kNoEcho: return grids::Echo::kNone;
    case PointLabel::kMoving: return grids::Echo::kMoving;
    case PointLabel::kStationary:
    case PointLabel::kUnknown: break;  // nothing contradicts that it stands there
  }
  return grids::Echo::kStationary;
}

/// Without anybody's labels: what the map does not explain stays out of it.
grids::Echo unexplained_out(EndCell end_cell) {
  return end_cell == EndCell::kNoEcho || end_cell == EndCell::kFree ? grids::Echo::kNone : grids::Echo::kStationary;
}

}  // namespace

Localizer::Localizer(const LocalizerConfig& config, work::SideWork* help)
    : config_(config),
      help_(help),
      match_without_wheels_(config.match),
      match_by_scans_alone_(config.match),
      scan_stamps_(config.far_ahead_s),
      prediction_(config),
      covariance_(config),
      searcher_(config.search),
      finder_(finder_config(config.search)),
      matcher_(help) {
  match_without_wheels_.unproven_share = 1.0;
  match_without_wheels_.information_share = 1.0;
  match_by_scans_alone_.information_share = 1.0;
  match_by_scans_alone_.body_sigma_m = config.body_sigma_without_wheels_m;
  match_by_scans_alone_.coarse_prior_sigmas = kCoarsePriorSigmas;
  progress_.sweep_factor.variance = config.sweep_factor_sigma * config.sweep_factor_sigma;
}

void Localizer::add_odometry(const sensing::Odometry& sample) {
  prediction_.add(sample);
}

void Localizer::expect(const flow::TrackedObjects& objects) {
  spare_objects_.resize(expected_objects_.objects, objects.objects.size());
  expected_objects_ = objects;
}

bool Localizer::is_usable(const sensing::LaserScan& scan) {
  if (!scan_stamps_.believes(scan.stamp_ns)) {
    ++progress_.counters.far_ahead_scans;
    return false;
  }
  if (!prediction_.last() || scan.stamp_ns > prediction_.last()->stamp_ns) return true;
  if (scan.stamp_ns < prediction_.last()->stamp_ns) {
    ++progress_.counters.out_of_order_scans;
    return false;
  }
  // After a crash nobody knows whose scan it was.
  const bool is_new = !scanners_at_last_.empty() && std::ranges::find(scanners_at_last_, scan.scanner.scanner_id) == scanners_at_last_.end();
  if (!is_new) ++progress_.counters.duplicate_scans;
  return is_new;
}

void Localizer::mask_expected_objects(std::int64_t stamp_ns) {
  masks_.clear();
  const double after_s = static_cast<double>(stamp_ns - expected_objects_.stamp_ns) * kNanosecond_s;
  if (after_s > kLongestExpectation_s || !config_.leave_out_moving) return;
  for (const flow::TrackedObject& object : expected_objects_.objects) {
    if (!object.confirmed) continue;
    masks_.push_back(box_of(object, after_s, config_.mask_margin_m));
  }
}

bool Localizer::is_masked(const Vector2& point_in_odom_m) const {
  return std::ranges::any_of(masks_, [&](const grids::Box& mask) { return mask.covers(point_in_odom_m); });
}

void Localizer::select_points(const sensing::LaserScan& scan, const Pose2& odom_from_base) {
  match_points_.clear();
  share_of_sweep_.clear();
  candidate_beams_.clear();
  laser_in_base_m_ = scan.scanner.base_from_laser.translation_m();
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.heading_rad);
  mask_expected_objects(scan.stamp_ns);
  for (std::size_t beam = 0; beam < scan.range_m.size(); ++beam) {
    const float range_m = scan.range_m[beam];
    if (!sensing::is_echo(range_m, std::min(config_.match_range_m, scan.scanner.max_range_m)) || range_m < config_.min_range_m) continue;
    if (is_masked(odom_from_base.translation_m() + turn * points_in_base_m_[beam])) continue;
    candidate_beams_.push_back(beam);
    if (std::ranges::binary_search(left_out_beams_, beam)) continue;
    match_points_.push_back({points_in_base_m_[beam], config_.range_noise_m + config_.range_noise_per_m * static_cast<double>(range_m)});
    if (learns_sweep(scan)) share_of_sweep_.push_back(static_cast<double>(beam) / static_cast<double>(scan.range_m.size()));
  }
}

bool Localizer::learns_sweep(const sensing::LaserScan& scan) const { return progress_.sweep_factor.variance > 0.0 && scan.scanner.sweep_s > 0.0; }

double Localizer::true_sweep_s(const sensing::LaserScan& scan) const {
  return learns_sweep(scan) ? progress_.sweep_factor.value * scan.scanner.sweep_s : scan.scanner.sweep_s;
}

const sensing::LaserScan& Localizer::with_true_sweep(const sensing::LaserScan& scan) {
  if (!learns_sweep(scan)) return scan;
  swept_scan_ = scan;
  swept_scan_.scanner.sweep_s = true_sweep_s(scan);
  return swept_scan_;
}

void Localizer::learn_sweep(const sensing::LaserScan& scan, const Step& step, const ScanMatch& found) {
  if (!learns_sweep(scan)) return;
  const SweptScan swept{match_points_, share_of_sweep_, found.odom_from_base.pose, step.prior().covariance.inverse(), scan.scanner.sweep_s,
                        {step.speed_mps, step.yaw_rate_radps}, step.duration_s};
  progress_.sweep_factor = learned(progress_.sweep_factor, swept, map_.surfels(), config_.match, config_.sweep_factor_sigma * config_.sweep_factor_sigma);
}

bool Localizer::is_vague(const UncertainPose2& prior) const {
  const double position_m2 = std::max(prior.covariance(0, 0), prior.covariance(1, 1));
  return position_m2 > config_.search_when_sigma_m * config_.search_when_sigma_m ||
         prior.covariance(2, 2) > config_.search_when_heading_sigma_rad * config_.search_when_heading_sigma_rad;
}

Pose2 Localizer::search(const UncertainPose2& prior) {
  const std::vector<matching::Peak> peaks = peaks_around(prior, searcher_);
  return peaks.empty() ? prior.pose : peaks.front().target_from_source.pose;
}

std::vector<matching::Peak> Localizer::peaks_around(const UncertainPose2& prior, matching::CorrelativeMatcher& searcher) {
  ++progress_.counters.searches;
  const auto reach = [&](int axis) { return config_.search_sigmas * std::sqrt(prior.covariance(axis, axis)); };
  const double farthest_m = config_.search_reach_m;  // beyond it there is no target, however unsure the prediction is
  const matching::SearchWindow window{std::min(reach(0), farthest_m), std::min(reach(1), farthest_m), std::min(reach(2), std::numbers::pi)};
  std::vector<matching::TargetPoint> targets;
  for (const grids::SurfelView& surfel : map_.surfels().all()) {
    targets.push_back({static_cast<float>(surfel.mean_m.x()), static_cast<float>(surfel.mean_m.y()), 1.0F});
  }
  searcher.set_target(targets, {prior.pose.translation_m(), config_.search_reach_m, config_.search_reach_m, std::max(window.half_x_m, window.half_y_m)});
  std::vector<Eigen::Vector2f> points;
  for (const matching::MatchPoint& point : match_points_) points.push_back(point.in_base_m.cast<float>());
  return searcher.search(points, prior.pose, window);
}

matching::PointToLineResult Localizer::match_in_closed_form(const Step& step) {
  const UncertainPose2 prior = step.prior();
  const matching::PointToLineConfig& config = match_config(step.source);
  const auto match_from = [&](const Pose2& initial) { return matcher_.match(match_points_, map_.surfels(), prior, initial, config); };
  if (!is_vague(prior)) return match_from(prior.pose);
  // What a search has found is not as far off as the prediction was.
  const auto match_from_search = [&] {
    matching::PointToLineConfig where_it_is = config;
    where_it_is.coarse_prior_sigmas = 0.0;
    return matcher_.match(match_points_, map_.surfels(), prior, search(prior), where_it_is);
  };
  if (!step.last_was_sampled) return match_from_search();
  // Along a featureless wall a search finds any place as good as any other.
  const matching::PointToLineResult result = match_from(prior.pose);
  return says_little(result.scan_information, config_.ambiguous) ? result : match_from_search();
}

ScanMatch Localizer::match(const Step& step, std::uint32_t scan_sequence) {
  const UncertainPose2 prior = step.prior();
  if (static_cast<int>(match_points_.size()) < config_.min_echoes) {
    ++progress_.counters.too_few_echoes;
    return {.odom_from_base = prior};
  }
  const matching::PointToLineResult result = match_in_closed_form(step);
  if (result.matched_share < config_.least_matched_share) {
    ++progress_.counters.lost_matches;
    return {.odom_from_base = prior, .is_lost = true};
  }
  if (says_little(result.scan_information, config_.ambiguous)) {
    ++progress_.counters.sampled_matches;
    const UncertainPose2 sampled = ambiguous_matcher_.match({match_points_, map_.surfels(), prior, result}, config_.ambiguous, match_config(step.source), scan_sequence);
    return {.odom_from_base = sampled, .is_believed = true, .was_sampled = true, .rms_residual_m = result.rms_residual_m};
  }
  return {.odom_from_base = result.map_from_base, .is_believed = true, .rms_residual_m = result.rms_residual_m, .new_share = result.new_share};
}

/// A single step that wheels are silent or wrong about may be one into what nobody has seen before: what is new counts in full. Without
/// any wheels it would make the map of its own lag: where each scan is matched against the last one, nothing tells how slow it has become.
const matching::PointToLineConfig& Localizer::match_config(StepSource source) const {
  switch (source) {
    case StepSource::kOdometry: return config_.match;
    case StepSource::kVelocityThisOnce: return match_without_wheels_;
    case StepSource::kVelocityAlone: break;
  }
  return match_by_scans_alone_;
}

void Localizer::travel(const Pose2& before_from_base) {
  const double moved_m = std::hypot(before_from_base.x_m, before_from_base.y_m);
  progress_.travelled_m += moved_m;
  const double position_m2 = config_.drift_m_per_sqrt_m * config_.drift_m_per_sqrt_m * moved_m;
  const double heading_rad2 = config_.drift_rad_per_sqrt_m * config_.drift_rad_per_sqrt_m * moved_m;
  progress_.drift.diagonal() += Eigen::Vector3d(position_m2, position_m2, heading_rad2);
}

flow::LocalizedScan Localizer::describe(const sensing::LaserScan& scan, const UncertainPose2& odom_from_base, flow::LocalizedScan done_with) {
  flow::LocalizedScan localized;
  localized.beams = std::move(done_with.beams);
  localized.stamp_ns = scan.stamp_ns;
  localized.sequence = scan.sequence;
  localized.scanner_id = scan.scanner.scanner_id;
  localized.base_from_laser = scan.scanner.base_from_laser;
  localized.max_range_m = scan.scanner.max_range_m;
  localized.beam_step_rad = scan.scanner.beam_step_rad;
  localized.sweep_s = true_sweep_s(scan);
  localized.odom_from_base = odom_from_base;
  localized.map_from_odom = map_from_odom_;
  localized.speed_mps = prediction_.last()->speed_mps;
  localized.yaw_rate_radps = prediction_.last()->yaw_rate_radps;
  localized.submap_id = map_.submap_id();
  localized.submap_from_base = geometry::inverse(map_.odom_from_submap()) * odom_from_base.pose;
  const Pose2 odom_from_laser = odom_from_base.pose * scan.scanner.base_from_laser;
  const Vector2 origin_in_odom_m = odom_from_laser.translation_m();
  const geometry::Matrix2 turn = geometry::rotation(odom_from_base.pose.heading_rad);
  localized.beams.resize(scan.range_m.size());
  beams_in_odom_.resize(scan.range_m.size());
  sensing::TurningDirection beam_in_odom(odom_from_laser.heading_rad + sensing::beam_angle_rad(scan.scanner, 0), scan.scanner.beam_step_rad);
  for (Vector2& beam : beams_in_odom_) beam = beam_in_odom.now(), beam_in_odom.advance();
  const auto end_of = [&](std::size_t i) -> Vector2 {
    if (localized.beams[i].range_m > 0.0F) return odom_from_base.pose.translation_m() + turn * points_in_base_m_[i];
    return origin_in_odom_m + scan.scanner.max_range_m * beams_in_odom_[i];
  };
  map_.evidence();  // what is still on its way into it comes first: then it only answers
  constexpr std::size_t kRanges = 4;
  work::share_in_ranges(help_, localized.beams.size(), kRanges, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      flow::LocalizedBeam& beam = localized.beams[i] = {};
      const bool has_echo = sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m) && scan.range_m[i] >= config_.min_range_m;
      beam.point_in_base_m = points_in_base_m_[i].cast<float>();
      beam.range_m = has_echo ? scan.range_m[i] : 0.0F;
      if (has_echo) map_.look_up_end(end_of(i), beam);
    }
  });
  list_asked_beams(localized);
  work::share_in_ranges(help_, asked_beams_.size(), kRanges, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t beam = asked_beams_[i];
      localized.beams[beam].expected_range_m = map_.expected_range_m(origin_in_odom_m, end_of(beam), scan.scanner.max_range_m);
    }
  });
  return localized;
}

/// Those near which an echo contradicts the map: elsewhere nobody asks what the map expected, and to tell it of all costs more than the match.
void Localizer::list_asked_beams(const flow::LocalizedScan& localized) {
  asked_beams_.clear();
  const std::size_t count = localized.beams.size();
  for (std::size_t i = 0, next = 0; i < count; ++i) {
    if (!config_.expects_all_ranges && localized.beams[i].end_cell != EndCell::kFree) continue;
    const std::size_t end = std::min(i + flow::kExpectedAside + 1, count);
    for (next = std::max(next, i < flow::kExpectedAside ? 0 : i - flow::kExpectedAside); next < end; ++next) asked_beams_.push_back(next);
  }
}

void Localizer::remember(const sensing::LaserScan& scan, const flow::LocalizedScan& localized) {
  const Pose2 odom_from_laser = localized.odom_from_base.pose * scan.scanner.base_from_laser;
  PendingScan& pending = pending_.push_back();
  pending.fallback.clear();
  pending.stamp_ns = scan.stamp_ns;
  pending.sequence = scan.sequence;
  pending.scanner_id = scan.scanner.scanner_id;
  pending.beam_step_rad = scan.scanner.beam_step_rad;
  // As long as wheels are trusted the map grows: round a corner everything may be new.
  pending.is_withheld = progress_.lost_scans > 0;
  pending.is_doubted = progress_.contradicts_map;
  pending.origin_in_odom_m = odom_from_laser.translation_m();
  pending.rays.resize(localized.beams.size());
  pending.end_cells.resize(localized.beams.size());
  const geometry::Matrix2 turn = geometry::rotation(localized.odom_from_base.pose.heading_rad);
  for (std::size_t i = 0; i < localized.beams.size(); ++i) {
    const flow::LocalizedBeam& beam = localized.beams[i];
    pending.end_cells[i] = beam.end_cell;
    pending.rays[i].echo = grids::Echo::kNone;
    if (beam.end_cell != EndCell::kNoEcho) {
      pending.rays[i].end_m = localized.odom_from_base.pose.translation_m() + turn * points_in_base_m_[i];
      const bool is_far = (pending.rays[i].end_m - pending.origin_in_odom_m).squaredNorm() > config_.map_range_m * config_.map_range_m;
      pending.rays[i].echo = is_far ? grids::Echo::kTooFar : grids::Echo::kStationary;
      continue;
    }
    // Nearer echoes than the least range tell nothing, not even that there is free space.
    const bool is_too_near = sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m);
    const double free_m = is_too_near ? 0.0 : std::min(config_.map.no_echo_free_m, scan.scanner.max_range_m);
    pending.rays[i].end_m = pending.origin_in_odom_m + free_m * beams_in_odom_[i];
  }
  if (pending_.size() == 1 && !pending.is_withheld) map_.prepare(pending.origin_in_odom_m, pending.rays, pending.beam_step_rad);
}

std::optional<flow::LocalizedScan> Localizer::localize(const sensing::LaserScan& scan, flow::LocalizedScan done_with) {
  if (!is_usable(scan)) return std::nullopt;
  ++progress_.counters.scans;
  integrate_overdue(scan.stamp_ns);
  begin_next_submap_if_due();
  if (!prediction_.last() || prediction_.last()->stamp_ns != scan.stamp_ns) scanners_at_last_.clear();
  scanners_at_last_.push_back(scan.scanner.scanner_id);
  left_out_beams_.clear();
  if (prediction_.last()) {
    const bool was_lost = progress_.lost_since_ns.has_value();
    before_scan_ = progress();
    match_points_before_.swap(match_points_);
    if (!place(scan) || was_lost) before_scan_.reset();  // labels by a map in which it may be elsewhere are worth nothing
  } else {
    begin(scan);
  }
  flow::LocalizedScan localized = describe(scan, covariance_.published(prediction_.estimate()), std::move(done_with));
  remember(scan, localized);
  return localized;
}

/// The first scan: the map begins where it is.
void Localizer::begin(const sensing::LaserScan& scan) {
  map_ = LocalMap(config_.map, Vector2::Zero(), help_, first_submap_);
  sensing::deskew(scan, 0.0, 0.0, points_in_base_m_);
  prediction_.begin(scan.stamp_ns);
}

/// Takes the estimate to a scan after the first. False where its match is not believed.
bool Localizer::place(const sensing::LaserScan& scan) {
  const Step step = prediction_.predict(scan.stamp_ns);
  count(step);
  sensing::deskew(with_true_sweep(scan), step.speed_mps, step.yaw_rate_radps, points_in_base_m_);
  select_points(scan, step.after.odom_from_base);
  const ScanMatch found = match_or_find(step, scan);
  prediction_.observe(step, found);
  covariance_.observe(step, found);
  if (found.is_believed && !found.was_sampled) learn_sweep(scan, step, found);
  travel(matched_step(step, found));
  if (has_gone_astray(scan.stamp_ns)) begin_astray_submap();
  return found.is_believed && !found.is_lost && !progress_.lost_since_ns;
}

void Localizer::count(const Step& step) {
  if (step.is_gap) ++progress_.counters.gaps;
  if (step.has_doubted_wheels) ++progress_.counters.odometry_jumps;
  else if (!step.is_by_wheels()) ++progress_.counters.without_odometry;
}

Localizer::Progress Localizer::progress() const {
  Progress now = progress_;
  now.prediction = prediction_.state();
  now.covariance = covariance_.state();
  return now;
}

void Localizer::return_to(const Progress& progress) {
  progress_ = progress;
  prediction_.set_state(progress.prediction);
  covariance_.set_state(progress.covariance);
}

bool Localizer::can_be_placed_again(const sensing::LaserScan& scan, const std::vector<PointLabel>& labels) const {
  if (!before_scan_ || pending_.empty() || !config_.leave_out_moving) return false;
  const PendingScan& pending = pending_.back();
  const bool is_it = pending.sequence == scan.sequence && pending.scanner_id == scan.scanner.scanner_id && pending.stamp_ns == scan.stamp_ns;
  return is_it && labels.size() == scan.range_m.size();
}

/// Of the beams that are to be matched, those whose echoes the labels keep out of the SO-map.
std::vector<std::size_t> Localizer::kept_out(const std::vector<PointLabel>& labels) const {
  std::vector<std::size_t> beams;
  std::ranges::copy_if(candidate_beams_, std::back_inserter(beams), [&](std::size_t beam) { return echo_of(labels[beam]) != grids::Echo::kStationary; });
  return beams;
}

std::optional<flow::LocalizedScan> Localizer::localize_again(const sensing::LaserScan& scan, const std::vector<PointLabel>& labels) {
  if (!can_be_placed_again(scan, labels)) return std::nullopt;
  std::vector<std::size_t> left_out = kept_out(labels);
  if (left_out == left_out_beams_) return std::nullopt;  // the same points give the same pose
  const Progress with_more_points = progress();
  left_out_beams_ = std::move(left_out);
  return_to(*before_scan_);
  if (!place(scan)) {
    return_to(with_more_points);
    return std::nullopt;
  }
  pending_.pop_back();
  flow::LocalizedScan localized = describe(scan, covariance_.published(prediction_.estimate()), {});
  remember(scan, localized);
  return localized;
}

void Localizer::note(const flow::SegmentedScan& segmented) {
  for (PendingScan& scan : pending_.all()) {
    const bool is_it = scan.sequence == segmented.sequence && scan.scanner_id == segmented.scanner_id;
    if (is_it && segmented.labels.size() == scan.rays.size()) scan.fallback = segmented.labels;
  }
}

void Localizer::integrate_first(const std::vector<PointLabel>* labels) {
  PendingScan& scan = pending_.front();
  if (scan.is_withheld) {
    ++progress_.counters.withheld_scans;
    pending_.pop_front();
    return;
  }
  for (std::size_t i = 0; i < scan.rays.size(); ++i) {
    if (scan.rays[i].echo != grids::Echo::kStationary || !config_.leave_out_moving) continue;
    scan.rays[i].echo = labels ? echo_of((*labels)[i]) : unexplained_out(scan.end_cells[i]);
  }
  if (scan.is_doubted && progress_.lost_since_ns) doubted_.push_back(std::move(scan));
  else integrate(scan);
  pending_.pop_front();
}

/// Takes it, and leaves memory in its place.
void Localizer::integrate(PendingScan& scan) {
  before_scan_.reset();  // the map is no longer what the last scan was matched against
  map_.integrate(scan.stamp_ns, scan.origin_in_odom_m, scan.rays, scan.beam_step_rad);
  if (integrated_.size() == kScansKeptForRestoring) integrated_.pop_front();
  std::swap(integrated_.push_back(), scan);
}

void Localizer::integrate_first_without_tracking() {
  ++progress_.counters.fallback_integrations;
  integrate_first(pending_.front().fallback.empty() ? nullptr : &pending_.front().fallback);
}

void Localizer::integrate_overdue(std::int64_t now_ns) {
  const auto is_overdue = [&] {
    const double waited_s = static_cast<double>(now_ns - pending_.front().stamp_ns) * kNanosecond_s;
    return static_cast<int>(pending_.size()) >= config_.max_pending || waited_s > config_.longest_label_wait_s;
  };
  while (!pending_.empty() && is_overdue()) integrate_first_without_tracking();
}

void Localizer::integrate(const flow::ScanLabels& labels) {
  const auto is_labelled = [&](const PendingScan& scan) {
    return scan.sequence == labels.sequence && scan.scanner_id == labels.scanner_id && scan.rays.size() == labels.labels.size();
  };
  const bool is_awaited = std::ranges::any_of(pending_.all(), is_labelled);
  while (is_awaited && !is_labelled(pending_.front())) integrate_first_without_tracking();
  if (is_awaited) integrate_first(&labels.labels);
  restore_points(labels);
  if (is_awaited) free_bodies(labels);
}

void Localizer::restore_points(const flow::ScanLabels& labels) {
  for (const flow::RestoredPoints& restored : labels.restored) {
    auto integrated = integrated_.all();
    const auto is_it = [&](const PendingScan& one) { return one.sequence == restored.sequence && one.scanner_id == labels.scanner_id; };
    const auto found = std::ranges::find_if(integrated, is_it);
    if (found == integrated.end()) continue;
    PendingScan& scan = *found;
    for (const std::uint16_t beam : restored.beams) {
      if (beam >= scan.rays.size() || scan.end_cells[beam] == EndCell::kNoEcho || scan.rays[beam].echo == grids::Echo::kTooFar) continue;
      map_.restore_stationary(scan.rays[beam].end_m, std::exchange(scan.rays[beam].echo, grids::Echo::kStationary));
      ++progress_.counters.restored_points;
    }
  }
}

void Localizer::free_bodies(const flow::ScanLabels& labels) {
  constexpr double kMarginM = 0.1;  // half a cell: echoes come from the sides themselves
  if (expected_objects_.sequence != labels.sequence || expected_objects_.stamp_ns != labels.stamp_ns || !config_.leave_out_moving) return;
  for (const flow::TrackedObject& object : expected_objects_.objects)
    if (is_surely_moving_vehicle(object, labels.stamp_ns)) map_.drive_over(box_of(object, 0.0, kMarginM));
}

void Localizer::begin_next_submap_if_due() {
  if (!prediction_.last()) return;
  const double counted_m = short_submaps_left_ > 0 ? kShorterBy * progress_.travelled_m : progress_.travelled_m;
  if (!submap_is_ended_ && !map_.is_outgrown(prediction_.estimate().odom_from_base.translation_m(), counted_m)) return;
  if (!submap_is_ended_) end_submap();
  const Pose2 odom_from_previous = map_.odom_from_submap();
  map_.begin_next(prediction_.estimate().odom_from_base.translation_m());
  previous_from_submap_ = {geometry::inverse(odom_from_previous) * map_.odom_from_submap(), progress_.drift};
  progress_.drift.setZero();
  progress_.travelled_m = 0.0;
  submap_is_ended_ = false;
  if (short_submaps_left_ > 0) --short_submaps_left_;
}

void Localizer::end_submap() {
  flow::Submap submap = map_.submap();
  submap.previous_from_submap = previous_from_submap_;
  submap.submap_from_base_at_end = geometry::inverse(map_.odom_from_submap()) * prediction_.estimate().odom_from_base;
  submap.travelled_m = progress_.travelled_m;
  finished_.push_back(std::move(submap));
  submap_is_ended_ = true;
  ++progress_.counters.submaps;
}

std::optional<flow::Submap> Localizer::take_finished_submap() {
  if (finished_.empty()) return std::nullopt;
  flow::Submap submap = std::move(finished_.front());
  finished_.erase(finished_.begin());
  return submap;
}

void Localizer::finish() {
  while (!pending_.empty()) integrate_first_without_tracking();
  if (prediction_.last() && !submap_is_ended_ && map_.has_echoes()) end_submap();
}

void Localizer::correct(const flow::GraphCorrection& correction) {
  if (correction.sequence <= correction_sequence_) return;
  correction_sequence_ = correction.sequence;
  map_from_odom_ = correction.map_from_odom;
}

template <typename Self, typename State, typename Visitor>
void Localizer::for_each_part(Self& self, State& progress, Visitor visit) {
  auto& last = *progress.prediction.last;
  visit(last.stamp_ns);
  for (auto* estimate : {&progress.prediction.estimate, &progress.prediction.with_stamp_offset}) {
    visit(estimate->odom_from_base);
    visit(estimate->calibration);
    visit(estimate->velocity);
    visit(estimate->covariance);
  }
  visit(progress.prediction.applies_stamp_offset);
  visit(progress.covariance.factors.of_axis);
  visit(progress.covariance.factors.dead_reckoned);
  visit(progress.covariance.map_change.way_m);
  visit(progress.covariance.map_change.squared_residuals);
  visit(progress.sweep_factor.value);
  visit(progress.sweep_factor.variance);
  visit(last.has_wheels);
  visit(last.wheel_from_base);
  visit(last.knows_velocity);
  visit(last.was_sampled);
  visit(last.speed_mps);
  visit(last.yaw_rate_radps);
  visit(last.doubted_wheels);
  visit(last.trusted_s);
  visit(last.stood_s);
  visit(self.map_from_odom_);
  visit(self.correction_sequence_);
  visit(self.previous_from_submap_.pose);
  visit(self.previous_from_submap_.covariance);
  visit(progress.drift);
  visit(progress.travelled_m);
  visit(self.submap_is_ended_);
  visit(self.short_submaps_left_);
  visit(progress.counters);
}

std::vector<std::byte> Localizer::checkpoint() const {
  std::vector<std::byte> bytes;
  if (!prediction_.last()) return bytes;
  put(bytes, kCheckpointMark);
  const Progress now = progress();
  for_each_part(*this, now, [&](const auto& part) { put(bytes, part); });
  put_all(bytes, prediction_.recent_odometry());
  map_.write(bytes);
  put(bytes, checksum(bytes));
  return bytes;
}

bool Localizer::restore(std::span<const std::byte> bytes) {
  const auto content = unsealed(bytes);
  if (!content) return false;
  ByteReader from(*content);
  Localizer restored(config_, help_);
  std::uint64_t mark = 0;
  Progress progress = restored.progress();
  auto& last = progress.prediction.last.emplace();
  from.get(mark);
  for_each_part(restored, progress, [&](auto& part) { from.get(part); });
  if (mark != kCheckpointMark) return false;
  std::vector<sensing::Odometry> odometry;
  from.get_all(odometry);
  std::optional<LocalMap> map = LocalMap::restored(config_.map, from, help_);
  const bool is_sound = is_believable(restored.map_from_odom_) &&
                        is_believable(restored.previous_from_submap_.pose) &&
                        is_believable(restored.previous_from_submap_.covariance) && is_believable(progress.drift) &&
                        is_believable(progress.prediction.estimate) && is_believable(progress.prediction.with_stamp_offset) &&
                        progress.covariance.factors.of_axis.minCoeff() >= 0.0 && progress.covariance.factors.of_axis.allFinite() &&
                        progress.covariance.factors.dead_reckoned.minCoeff() >= 0.0 && progress.covariance.factors.dead_reckoned.maxCoeff() <= 1.0 &&
                        progress.covariance.map_change.way_m >= 0.0 && std::isfinite(progress.covariance.map_change.way_m) &&
                        progress.covariance.map_change.squared_residuals >= 0.0 && std::isfinite(progress.covariance.map_change.squared_residuals) &&
                        std::isfinite(progress.sweep_factor.value) && progress.sweep_factor.variance >= 0.0 &&
                        last.trusted_s >= 0.0 && last.stood_s >= 0.0 && std::hypot(last.speed_mps, last.yaw_rate_radps) < kFastestRestored &&
                        std::abs(static_cast<double>(last.stamp_ns)) < kFarthestStamp_ns && std::isfinite(progress.travelled_m) &&
                        std::ranges::all_of(odometry, [](const sensing::Odometry& sample) { return is_believable(sample.wheel_from_base); });
  if (!map || !is_sound || !from.ok() || !from.at_end()) return false;
  restored.return_to(progress);
  restored.map_ = std::move(*map);
  restored.prediction_.resume(progress.prediction, odometry, std::move(prediction_));
  *this = std::move(restored);
  return true;
}

}  // namespace slammot::localization
