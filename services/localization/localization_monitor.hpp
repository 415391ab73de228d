#pragma once

#include <cstdint>
#include <optional>

#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/map_admission.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_match.hpp"
#include "services/localization/scan_points.hpp"

namespace slammot::localization {

/// A match with all that it is judged by.
struct MatchToJudge {
  const ScanMatch& match;
  const Step& step;    ///< Its prediction was the prior.
  double usual_share;  ///< Of points that match.
  const ScanPoints& points;
  const LocalMap& map;
};

/// Judges from scan to scan whether the vehicle is where the estimate has it: whether scans match,
/// and whether the map is contradicted by them. For each scan after the first: judge(), and
/// confirm() where the match is believed in the end.
class LocalizationMonitor {
 public:
  /// Scans in a row that match before a pose that was found again is believed.
  static constexpr int kFoundScans = 3;
  /// Time of a search in vain after which a new map begins, tied loosely to the last one.
  static constexpr double kAstrayAfterS = 2.0;

  enum class Verdict {
    kFits,        ///< Nothing speaks against the match, or there was too little to match.
    kDoesNotFit,  ///< The prediction is trusted for now, or for good.
    kLost,        ///< The pose is to be searched for.
  };

  struct State {
    std::optional<std::int64_t> lost_since_ns;  ///< Stamp of the first scan that did not fit.
    int unmatched_scans = 0;                    ///< Since then.
    int lost_scans = 0;                         ///< Since the prediction is no longer trusted.
    int scans_to_prove = 0;        ///< Until it is believed that the pose was found again.
    bool contradicts_map = false;  ///< The scan at hand, where it was matched.
    std::optional<double> explained_before = 0.0;  ///< Share of the last scan's points that the map
                                                   ///< explained; none: not asked.
    bool everything_changed = false;               ///< From one scan to the next, when it was lost.
    bool begins_elsewhere = false;                 ///< At the scan at hand. Not in checkpoints.
  };

  explicit LocalizationMonitor(const LocalizerConfig& config) : config_(config) {}

  Verdict judge(const MatchToJudge& judged);

  /// A match is believed and fits, perhaps after a search. Whether the vehicle is where it says: in
  /// a wrong place a scan or two may fit.
  bool confirm();

  /// Whether wheels have leapt and the scan does not fit where the vehicle was: a drive that begins
  /// anew, elsewhere, in the same log. Where wheels alone have leapt the scan fits as usual.
  bool begins_elsewhere() const { return state_.begins_elsewhere; }

  /// Whether the pose was searched for in vain for so long that a new map is to begin.
  bool has_gone_astray(std::int64_t stamp_ns) const;

  /// A new map begins: what did not fit was the old one.
  void begin_map();

  /// Stamp of the first scan that did not fit; none: the last one did.
  std::optional<std::int64_t> lost_since_ns() const { return state_.lost_since_ns; }
  bool is_lost() const { return state_.lost_scans > 0; }
  int lost_scans() const { return state_.lost_scans; }
  PoseTrust trust() const {
    return state_.lost_since_ns ? PoseTrust::kDoubted : PoseTrust::kConfirmed;
  }
  /// What may become of the scan at hand.
  MapAdmission admission() const;

  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

 private:
  bool is_contradicted(const MatchToJudge& judged);
  void compare_with_scan_before(const MatchToJudge& judged, double explained);
  bool contradicts_too_much(const MatchToJudge& judged, double explained) const;
  bool leaps_elsewhere(const MatchToJudge& judged) const;
  bool trusts_prediction(const Step& step) const;
  bool may_be_elsewhere(const Step& step) const {
    return !step.has_wheels() || config_.odometry.may_be_picked_up;
  }
  double lost_s(std::int64_t stamp_ns) const {
    return static_cast<double>(stamp_ns - *state_.lost_since_ns) * 1e-9;
  }

  LocalizerConfig config_;
  State state_;
};

}  // namespace slammot::localization
