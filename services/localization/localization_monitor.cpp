#include "services/localization/localization_monitor.hpp"

#include <cmath>

#include "services/localization/map_agreement.hpp"
#include "services/localization/pose_search.hpp"

namespace slammot::localization {
namespace {

constexpr double kMostContradictedWhenSure = 0.8;  // Lost, too, where the prediction is sure and so
                                                   // many of the points lie in what the map knows
                                                   // to be free: traffic alone does not put so many
                                                   // there.

constexpr int kPatientScans = 6;  // that need not fit, however long they take;
constexpr int kAstrayScans = 16;  // so many in vain before a new map begins
constexpr double kSeenThroughWalls_share = 0.1;
constexpr double kElsewhere_share = 0.25;  // of the usual fit
constexpr double kChanged_share = 0.5;     // of what was explained one scan before

bool is_same_view(const geometry::Pose2& before_from_now) {
  constexpr double kSameView_m = 1.0;
  constexpr double kSameView_rad = 0.2;
  return before_from_now.translation_m().norm() < kSameView_m &&
         std::abs(before_from_now.heading_rad) < kSameView_rad;
}

}  // namespace

LocalizationMonitor::Verdict LocalizationMonitor::judge(const MatchToJudge& judged) {
  state_.contradicts_map = false;
  bool is_contradicting = is_contradicted(judged);
  state_.begins_elsewhere = config_.recovery.recovers && leaps_elsewhere(judged);
  if (state_.begins_elsewhere) is_contradicting = state_.everything_changed = true;
  if (!is_contradicting && !judged.match.is_lost) return Verdict::kFits;
  if (!config_.recovery.recovers) return Verdict::kDoesNotFit;
  if (!state_.lost_since_ns) {
    state_.lost_since_ns = judged.step.stamp_ns;
    state_.unmatched_scans = 0;
  }
  ++state_.unmatched_scans;
  state_.scans_to_prove = kFoundScans + 1;
  state_.contradicts_map = is_contradicting;
  if (trusts_prediction(judged.step)) return Verdict::kDoesNotFit;
  ++state_.lost_scans;
  return Verdict::kLost;
}

bool LocalizationMonitor::leaps_elsewhere(const MatchToJudge& judged) const {
  return judged.step.wheels.have_leapt &&
         fit_at(judged.match.matched_share, judged.points, judged.match.odom_from_base.pose,
                judged.map, config_.map) < kElsewhere_share * judged.usual_share;
}

/// Traffic on all sides hides the map for as long as it likes: what drives and was not seen to be
/// moved trusts its wheels.
bool LocalizationMonitor::trusts_prediction(const Step& step) const {
  if (!step.has_wheels()) return false;
  return (!state_.everything_changed && !config_.odometry.may_be_picked_up) ||
         lost_s(step.stamp_ns) < config_.recovery.lost_after_s ||
         state_.unmatched_scans < kPatientScans;
}

bool LocalizationMonitor::confirm() {
  if (state_.scans_to_prove > 0 && --state_.scans_to_prove > 0) return false;
  state_.lost_since_ns.reset();
  state_.lost_scans = 0;
  return true;
}

/// Where the prediction is sure, much that contradicts the map is traffic; where it is not, the
/// match may be anywhere. But traffic stands before walls, and does not come from one scan to the
/// next. Where the vehicle has hardly moved, nothing does but the ground that a braking scanner
/// sees, and another place.
bool LocalizationMonitor::is_contradicted(const MatchToJudge& judged) {
  if (!judged.match.is_believed && !judged.match.is_lost) {
    state_.explained_before = 0.0;  // beams without echo have cleared the map meanwhile: nothing is
                                    // to be concluded from that
    return false;
  }
  if (!may_be_elsewhere(judged.step) && !state_.everything_changed) {
    state_.explained_before.reset();  // the map is not asked as long as nobody wants to know: it
                                      // may still be taking in the last scan
    return false;
  }
  const double explained =
      explained_share(judged.points.matched(), judged.match.odom_from_base.pose,
                      judged.map.evidence(), config_.map);
  compare_with_scan_before(judged, explained);
  return contradicts_too_much(judged, explained);
}

void LocalizationMonitor::compare_with_scan_before(const MatchToJudge& judged, double explained) {
  const geometry::Pose2& pose_before = judged.step.odom_from_base_before.pose;
  const double before = state_.explained_before
                            ? *state_.explained_before
                            : explained_share(judged.points.matched_before(), pose_before,
                                              judged.map.evidence(), config_.map);
  if (!state_.lost_since_ns)
    state_.everything_changed = may_be_elsewhere(judged.step) &&
                                before - explained > kChanged_share &&
                                is_same_view(judged.step.before_from_base);
  state_.explained_before = explained;
}

bool LocalizationMonitor::contradicts_too_much(const MatchToJudge& judged, double explained) const {
  const bool changed = state_.everything_changed;
  const bool was_lost = state_.lost_since_ns.has_value();
  const bool does_not_match = judged.match.is_lost;
  if (!may_be_elsewhere(judged.step) && !changed) return false;
  if (does_not_match && changed) return true;
  const auto there = [&] {
    return agreement(judged.points, judged.match.odom_from_base.pose, judged.map.evidence(),
                     config_.map);
  };
  if (is_vague(judged.step.prior(), config_))
    return there().contradicting_share() > kMostContradictedShare;
  if (was_lost && changed)
    return there().contradicting_share() > kFoundByHalf * kMostContradictedShare;
  if (!does_not_match && !was_lost && explained >= 1.0 - kMostContradictedWhenSure) return false;
  const double most =
      does_not_match || was_lost ? kMostContradictedShare : kMostContradictedWhenSure;
  const MapAgreement found = there();
  return found.contradicting_share() > most &&
         (changed || found.share_behind_walls() > kSeenThroughWalls_share);
}

bool LocalizationMonitor::has_gone_astray(std::int64_t stamp_ns) const {
  return state_.lost_since_ns && state_.lost_scans > 0 && state_.unmatched_scans > kAstrayScans &&
         lost_s(stamp_ns) > config_.recovery.lost_after_s + kAstrayAfterS;
}

void LocalizationMonitor::begin_map() {
  state_.lost_since_ns.reset();
  state_.lost_scans = 0;
  state_.scans_to_prove = 0;
  state_.contradicts_map = false;
}

/// As long as wheels are trusted the map grows: round a corner everything may be new.
MapAdmission LocalizationMonitor::admission() const {
  if (is_lost()) return MapAdmission::kWithheld;
  return state_.contradicts_map ? MapAdmission::kDoubted : MapAdmission::kMapped;
}

}  // namespace slammot::localization
