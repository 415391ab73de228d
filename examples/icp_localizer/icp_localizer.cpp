#include "examples/icp_localizer/icp_localizer.hpp"

#include <algorithm>
#include <cmath>

#include "common/sensing/deskew.hpp"

namespace slammot::icp_localizer {
namespace {

using flow::EndCell;
using flow::LocalizedScan;
using flow::PointLabel;
using geometry::Pose2;
using geometry::UncertainPose2;
using geometry::Vector2;

/// One sigma of the predicted step: a constant and a share of its length.
struct StepNoise {
  double position_m;
  double position_per_m;
  double heading_rad;
  double heading_per_rad;
};
constexpr StepNoise kByWheels{0.02, 0.1, 0.02, 0.2};
constexpr StepNoise kAtConstantVelocity{0.2, 0.2, 0.05, 0.5};

geometry::Matrix3 covariance_of(const Pose2& step, const StepNoise& noise) {
  const double position_m = noise.position_m + noise.position_per_m * step.translation_m().norm();
  const double heading_rad = noise.heading_rad + noise.heading_per_rad * std::abs(step.heading_rad);
  return Eigen::Vector3d(position_m * position_m, position_m * position_m,
                         heading_rad * heading_rad)
      .asDiagonal();
}

grids::Echo echo_of(PointLabel label, grids::Echo unlabelled) {
  if (unlabelled != grids::Echo::kStationary) return unlabelled;
  return label == PointLabel::kMoving   ? grids::Echo::kMoving
         : label == PointLabel::kNoEcho ? grids::Echo::kNone
                                        : grids::Echo::kStationary;
}

}  // namespace

void IcpLocalizer::add_odometry(const sensing::Odometry& sample) {
  if (config_.use_odometry) odometry_.add(sample);
}

std::optional<LocalizedScan> IcpLocalizer::localize(const sensing::LaserScan& scan,
                                                    LocalizedScan workspace) {
  if (is_late(scan)) {
    ++dropped_scans_;
    return std::nullopt;
  }
  while (static_cast<int>(pending_.size()) >= config_.max_pending) integrate_first(nullptr);
  begin_local_map_if_due();
  const Step step = scans_ == 0 ? Step{} : predicted_step(scan.stamp_ns);
  const bool has_velocity = step.duration_s > 0.0;
  sensing::deskew(
      scan, has_velocity ? step.before_from_base.x_m / step.duration_s : speed_mps_,
      has_velocity ? step.before_from_base.heading_rad / step.duration_s : yaw_rate_radps_,
      points_in_base_m_);
  const UncertainPose2 predicted{
      odom_from_base_.pose * step.before_from_base,
      covariance_of(step.before_from_base, step.is_by_wheels ? kByWheels : kAtConstantVelocity)};
  const std::optional<UncertainPose2> found = scans_ == 0 ? predicted : matched(scan, predicted);
  if (!found) ++unmatched_scans_;
  move_to(found.value_or(predicted), step.duration_s);
  ++scans_;
  last_stamp_ns_ = scan.stamp_ns;
  last_scanner_id_ = scan.scanner.scanner_id;
  LocalizedScan localized = described(scan, std::move(workspace));
  add_pending(scan, localized);
  return localized;
}

/// Several scanners may share a stamp.
bool IcpLocalizer::is_late(const sensing::LaserScan& scan) const {
  if (scan.range_m.empty()) return true;
  if (scans_ == 0 || scan.stamp_ns > last_stamp_ns_) return false;
  return scan.stamp_ns < last_stamp_ns_ || scan.scanner.scanner_id == last_scanner_id_;
}

IcpLocalizer::Step IcpLocalizer::predicted_step(std::int64_t stamp_ns) const {
  const double duration_s = static_cast<double>(stamp_ns - last_stamp_ns_) * 1e-9;
  const auto before = odometry_.wheel_from_base_at(last_stamp_ns_);
  const auto now = odometry_.wheel_from_base_at(stamp_ns);
  if (before && now) return {geometry::inverse(*before) * *now, duration_s, true};
  return {{speed_mps_ * duration_s, 0.0, yaw_rate_radps_ * duration_s}, duration_s, false};
}

/// nullopt if the scan has too few echoes, or too few echoes with a surfel.
std::optional<UncertainPose2> IcpLocalizer::matched(const sensing::LaserScan& scan,
                                                    const UncertainPose2& predicted) {
  const double most_m = std::min(config_.match_range_m, scan.scanner.max_range_m);
  std::vector<matching::MatchPoint> points;
  for (std::size_t i = 0; i < scan.range_m.size(); ++i)
    if (sensing::is_echo(scan.range_m[i], most_m) && scan.range_m[i] >= config_.min_range_m)
      points.push_back({points_in_base_m_[i], config_.range_noise_m});
  if (static_cast<int>(points.size()) < config_.min_echoes) return std::nullopt;
  matching::PointToLineConfig icp;
  icp.proven_after_m = 0.0;
  const matching::PointToLineResult result =
      matcher_.match(points, map_->surfels(), predicted, predicted.pose, icp);
  if (result.matched_share < config_.least_matched_share) return std::nullopt;
  return result.map_from_base;
}

void IcpLocalizer::move_to(const UncertainPose2& odom_from_base, double duration_s) {
  const Pose2 step = geometry::inverse(odom_from_base_.pose) * odom_from_base.pose;
  if (duration_s > 0.0) {
    speed_mps_ = step.x_m / duration_s;
    yaw_rate_radps_ = step.heading_rad / duration_s;
  }
  travelled_m_ += step.translation_m().norm();
  odom_from_base_ = odom_from_base;
}

/// Begins a local map before the first scan, after finish(), or when the present one is complete.
void IcpLocalizer::begin_local_map_if_due() {
  const Vector2 place_m = odom_from_base_.pose.translation_m();
  if (!map_) {
    map_.emplace(config_, flow::SubmapId{}, place_m);
    return;
  }
  const bool is_outgrown =
      (place_m - map_->odom_from_submap().translation_m()).norm() > config_.new_map_after_m ||
      travelled_m_ - map_began_at_m_ > config_.new_map_after_travel_m;
  if (is_outgrown) finish();
  if (!is_map_finished_) return;
  const Pose2 odom_from_previous = map_->odom_from_submap();
  const double way_m = travelled_m_ - map_began_at_m_;
  const double position_m2 = config_.drift_m_per_sqrt_m * config_.drift_m_per_sqrt_m * way_m;
  const double heading_rad2 = config_.drift_rad_per_sqrt_m * config_.drift_rad_per_sqrt_m * way_m;
  map_ = map_->next(place_m);
  previous_from_submap_ = {geometry::inverse(odom_from_previous) * map_->odom_from_submap(),
                           Eigen::Vector3d(position_m2, position_m2, heading_rad2).asDiagonal()};
  map_began_at_m_ = travelled_m_;
  is_map_finished_ = false;
}

void IcpLocalizer::finish() {
  while (!pending_.empty()) integrate_first(nullptr);
  if (!map_ || is_map_finished_ || !map_->has_scans()) return;
  flow::Submap submap = map_->submap();
  submap.previous_from_submap = previous_from_submap_;
  submap.submap_from_base_at_end =
      geometry::inverse(map_->odom_from_submap()) * odom_from_base_.pose;
  submap.travelled_m = travelled_m_ - map_began_at_m_;
  finished_.push_back(std::move(submap));
  is_map_finished_ = true;
}

std::optional<flow::Submap> IcpLocalizer::take_finished_submap() {
  if (finished_.empty()) return std::nullopt;
  flow::Submap submap = std::move(finished_.front());
  finished_.pop_front();
  return submap;
}

LocalizedScan IcpLocalizer::described(const sensing::LaserScan& scan,
                                      LocalizedScan localized) const {
  localized.stamp_ns = scan.stamp_ns;
  localized.sequence = scan.sequence;
  localized.scanner_id = scan.scanner.scanner_id;
  localized.base_from_laser = scan.scanner.base_from_laser;
  localized.max_range_m = scan.scanner.max_range_m;
  localized.beam_step_rad = scan.scanner.beam_step_rad;
  localized.sweep_s = scan.scanner.sweep_s;
  localized.odom_from_base = odom_from_base_;
  localized.map_from_odom = map_from_odom_;
  localized.speed_mps = speed_mps_;
  localized.yaw_rate_radps = yaw_rate_radps_;
  localized.submap_id = map_->id();
  localized.submap_from_base = geometry::inverse(map_->odom_from_submap()) * odom_from_base_.pose;
  localized.local_variance_share = 1.0;
  localized.beams.assign(scan.range_m.size(), {});
  for (std::size_t i = 0; i < localized.beams.size(); ++i) {
    flow::LocalizedBeam& beam = localized.beams[i];
    beam.point_in_base_m = points_in_base_m_[i].cast<float>();
    if (!sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m) ||
        scan.range_m[i] < config_.min_range_m)
      continue;
    beam.range_m = scan.range_m[i];
    map_->look_up_end(odom_from_base_.pose * points_in_base_m_[i], beam);
  }
  // Detection needs expected ranges only near echoes that contradict the map.
  const Pose2 odom_from_laser = odom_from_base_.pose * scan.scanner.base_from_laser;
  for (std::size_t i = 0; i < localized.beams.size(); ++i) {
    if (localized.beams[i].end_cell != EndCell::kFree) continue;
    for (std::size_t j = i - std::min(i, flow::kExpectedAside);
         j < std::min(i + flow::kExpectedAside + 1, localized.beams.size()); ++j) {
      const double direction_rad =
          odom_from_laser.heading_rad + sensing::beam_angle_rad(scan.scanner, j);
      localized.beams[j].expected_range_m = static_cast<float>(map_->expected_range_m(
          odom_from_laser.translation_m(), {std::cos(direction_rad), std::sin(direction_rad)},
          scan.scanner.max_range_m));
    }
  }
  return localized;
}

/// Stores the scan until its labels arrive; its echoes are mapped then.
void IcpLocalizer::add_pending(const sensing::LaserScan& scan, const LocalizedScan& localized) {
  const Pose2 odom_from_laser = odom_from_base_.pose * scan.scanner.base_from_laser;
  const Vector2 laser_m = odom_from_laser.translation_m();
  Pending& pending = pending_.emplace_back(
      Pending{scan.sequence,
              scan.scanner.scanner_id,
              {scan.stamp_ns, laser_m, {}, scan.scanner.beam_step_rad, travelled_m_}});
  for (std::size_t i = 0; i < scan.range_m.size(); ++i) {
    grids::Ray& ray = pending.scan.rays.emplace_back();
    if (localized.beams[i].range_m > 0.0F) {
      ray.end_m = odom_from_base_.pose * points_in_base_m_[i];
      ray.echo = (ray.end_m - laser_m).norm() > config_.map_range_m ? grids::Echo::kTooFar
                                                                    : grids::Echo::kStationary;
      continue;
    }
    const bool is_too_near = sensing::is_echo(scan.range_m[i], scan.scanner.max_range_m);
    const double free_m =
        is_too_near ? 0.0 : std::min(config_.no_echo_free_m, scan.scanner.max_range_m);
    const double direction_rad =
        odom_from_laser.heading_rad + sensing::beam_angle_rad(scan.scanner, i);
    ray.end_m = laser_m + free_m * Vector2(std::cos(direction_rad), std::sin(direction_rad));
  }
}

void IcpLocalizer::integrate(const flow::ScanLabels& labels) {
  const auto is_of_labels = [&](const Pending& pending) {
    return pending.sequence == labels.sequence && pending.scanner_id == labels.scanner_id &&
           pending.scan.rays.size() == labels.labels.size();
  };
  if (std::ranges::none_of(pending_, is_of_labels)) return;
  while (!is_of_labels(pending_.front())) integrate_first(nullptr);
  integrate_first(&labels.labels);
}

/// Without labels all points count as stationary.
void IcpLocalizer::integrate_first(const std::vector<PointLabel>* labels) {
  MappedScan& scan = pending_.front().scan;
  for (std::size_t i = 0; labels && i < scan.rays.size(); ++i)
    scan.rays[i].echo = echo_of((*labels)[i], scan.rays[i].echo);
  map_->add(scan);
  pending_.pop_front();
}

std::map<std::string, std::uint64_t> IcpLocalizer::named_counters() const {
  return {{"scans", scans_},
          {"dropped_scans", dropped_scans_},
          {"unmatched_scans", unmatched_scans_},
          {"submaps", map_ ? map_->id().value + (is_map_finished_ ? 1 : 0) : 0}};
}

}  // namespace slammot::icp_localizer
