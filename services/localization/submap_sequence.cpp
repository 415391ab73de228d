#include "services/localization/submap_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/squared.hpp"
#include "services/localization/submap_saliency.hpp"

namespace slammot::localization {
namespace {

using geometry::Pose2;
using geometry::squared;
using geometry::UncertainPose2;

constexpr double kShorterBy = 2.5;  // where it is not known where they lie, two are sooner there to
                                    // be searched for
constexpr std::int32_t kShortSubmaps = 4;  // loop closing needs two or three that agree

}  // namespace

void SubmapSequence::go_on_after(const flow::CorrectedSubmap& last) {
  first_submap_ = {last.submap_id.value + 1};
  state_.map_from_odom = last.map_from_submap;
  state_.previous_from_submap = {Pose2::identity(), config_.recovery.anywhere()};
  state_.short_submaps_left = kShortSubmaps;
}

void SubmapSequence::begin() {
  map_ = LocalMap(config_.map, geometry::Vector2::Zero(), help_, first_submap_);
}

/// The map drifts by the share of it that is renewed, times the match's variance. On streets that
/// is what the settings say; where little tells the heading it is more.
void SubmapSequence::travel(const Pose2& before_from_base, const ScanMatch& match) {
  const double moved_m = std::hypot(before_from_base.x_m, before_from_base.y_m);
  state_.travel.travelled_m += moved_m;
  const Eigen::Vector3d inherited = renewed_share(match, moved_m, config_.match.new_below_m) *
                                    match.odom_from_base.covariance.diagonal();
  const double position_m2 = std::max(squared(config_.errors.drift_m_per_sqrt_m) * moved_m,
                                      0.5 * (inherited.x() + inherited.y()));
  const double heading_rad2 =
      std::max(squared(config_.errors.drift_rad_per_sqrt_m) * moved_m, inherited.z());
  state_.travel.drift.diagonal() += Eigen::Vector3d(position_m2, position_m2, heading_rad2);
}

void SubmapSequence::doubt(const geometry::Vector2& up_to_m) {
  state_.travel.drift.topLeftCorner<2, 2>() += up_to_m * up_to_m.transpose() / 3.0;
}

bool SubmapSequence::begin_next_if_due(const Pose2& odom_from_base) {
  const double counted_m = state_.short_submaps_left > 0 ? kShorterBy * state_.travel.travelled_m
                                                         : state_.travel.travelled_m;
  if (!state_.is_ended && !map_.is_outgrown(odom_from_base.translation_m(), counted_m))
    return false;
  const bool ends_one = !state_.is_ended;
  if (ends_one) end(odom_from_base);
  const Pose2 odom_from_previous = map_.odom_from_submap();
  map_.begin_next(odom_from_base.translation_m());
  begin_with(
      {geometry::inverse(odom_from_previous) * map_.odom_from_submap(), state_.travel.drift});
  if (state_.short_submaps_left > 0) --state_.short_submaps_left;
  return ends_one;
}

bool SubmapSequence::begin_astray(const Pose2& odom_from_base, std::int64_t since_ns) {
  const Pose2 odom_from_previous = map_.odom_from_submap();
  const bool ends_one = finish(odom_from_base);
  map_.begin_astray(odom_from_base.translation_m(), since_ns);
  begin_with({geometry::inverse(odom_from_previous) * map_.odom_from_submap(),
              config_.recovery.anywhere()});
  state_.short_submaps_left = kShortSubmaps;
  return ends_one;
}

void SubmapSequence::begin_with(const UncertainPose2& previous_from_submap) {
  state_.previous_from_submap = previous_from_submap;
  state_.travel = {};
  state_.is_ended = false;
}

void SubmapSequence::end(const Pose2& odom_from_base) {
  flow::Submap submap = map_.submap();
  submap.previous_from_submap = state_.previous_from_submap;
  submap.submap_from_base_at_end = geometry::inverse(map_.odom_from_submap()) * odom_from_base;
  submap.travelled_m = state_.travel.travelled_m;
  measurements_.move_into(submap);
  finished_.push_back(std::move(submap));
  state_.is_ended = true;
}

bool SubmapSequence::finish(const Pose2& odom_from_base) {
  if (state_.is_ended || !map_.has_echoes()) return false;
  end(odom_from_base);
  return true;
}

std::optional<flow::Submap> SubmapSequence::take_finished() {
  if (finished_.empty()) return std::nullopt;
  flow::Submap submap = std::move(finished_.front());
  finished_.erase(finished_.begin());
  submap.saliency = saliency_of(submap);
  return submap;
}

void SubmapSequence::correct(const flow::GraphCorrection& correction) {
  if (correction.sequence <= state_.correction_sequence) return;
  state_.correction_sequence = correction.sequence;
  state_.map_from_odom = correction.map_from_odom;
}

void SubmapSequence::resume(const State& state, LocalMap map) {
  state_ = state;
  map_ = std::move(map);
}

}  // namespace slammot::localization
