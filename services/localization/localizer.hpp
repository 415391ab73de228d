#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/matching/correlative.hpp"
#include "common/matching/point_to_line.hpp"
#include "common/memory/recycling_queue.hpp"
#include "common/memory/spares.hpp"
#include "common/sensing/deskew.hpp"
#include "common/sensing/motion_model.hpp"
#include "common/sensing/odometry_buffer.hpp"
#include "common/sensing/scan.hpp"
#include "common/sensing/stamp_guard.hpp"
#include "common/sensing/variance_factor.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/ambiguous_match.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/sweep_estimate.hpp"
#include "services/localization/wheel_jump.hpp"

namespace slammot::localization {

struct LocalizerConfig {
  double match_range_m = 80.0;            ///< Echoes beyond it are not matched,
  double map_range_m = 80.0;              ///< and beyond this not mapped.
  double min_range_m = 0.3;               ///< Nearer echoes come from the vehicle itself.
  double range_noise_m = 0.03;            ///< One sigma at the scanner,
  double range_noise_per_m = 0.001;       ///< and what each metre of range adds.
  int min_echoes = 10;                    ///< With fewer, the prediction is the pose.
  double least_matched_share = 0.3;       ///< With fewer points matched, the match is not believed.
  double search_when_sigma_m = 0.15;      ///< A prediction less sure than this is searched for by correlation first,
  double search_when_heading_sigma_rad = 0.02;  ///< or less sure of the heading than this.
  double search_reach_m = 25.0;           ///< Half side of the square of the map that is searched.
  double search_sigmas = 3.0;             ///< Half width of the search window in standard deviations of the prediction.
  double most_contradicted_share = 0.5;   ///< Lost, too, where the prediction is vague and the match puts more points into what the map knows to be free,
  double most_contradicted_when_sure = 0.8;  ///< or where it is sure and the match puts so many there: traffic alone does not.
  double found_share = 0.6;               ///< Lost, it has found itself again where so many points match.
  int found_scans = 3;                    ///< And so many scans in a row, before they go into the map again.
  bool may_be_picked_up = false;          ///< And set down elsewhere, with wheels that notice nothing; a road vehicle is not.
  bool recovers = true;                   ///< Looks for itself after being carried away; off: goes on by dead reckoning.
  double lost_after_s = 3.0;              ///< Wheels are trusted for so long where scans do not match; then it looks for itself,
  double astray_after_s = 2.0;            ///< and after so long in vain a new map begins, tied to the last one by next to nothing:
  double astray_sigma_m = 50.0;           ///< one sigma of that tie.
  bool expects_all_ranges = false;        ///< Tells of every beam how far the map would let it go, not only of those near an echo that contradicts it.
  bool leave_out_moving = true;           ///< Off, to see what it is worth: everything is mapped and matched as if it stood.
  double sweep_factor_sigma = 0.0;        ///< Of the factor on how long scanners' sweeps are said to take; 0: they are right.
  double body_sigma_without_wheels_m = 0.15;  ///< match.body_sigma_m where no wheels say how far it is: whatever has most of the beams may be driving off.
  bool use_odometry = true;               ///< Off, for wheels that are worse than none: constant velocity predicts.
  double mask_margin_m = 0.4;             ///< Around a tracked object's box, left out of the match.
  double longest_step_s = 2.0;            ///< Without odometry nothing is extrapolated farther; longer gaps are counted.
  double far_ahead_s = 60.0;              ///< A stamp so far ahead of those before is believed when a second one agrees.
  double fastest_mps = 60.0;              ///< Odometry that says more has jumped.
  int max_pending = 4;                    ///< Scans that wait for labels before the map goes on without.
  double longest_label_wait_s = 0.15;     ///< Nor does it wait longer than this, by the scans' stamps.
  double variance_memory_s = 2.0;         ///< Over which published covariances are fitted to the surprises seen.
  double compared_over_s = 1.0;           ///< Published covariances are to be honest about the motion over this time.
  double drift_m_per_sqrt_m = 0.005;      ///< What dead reckoning by matching adds, one sigma, for submap constraints.
  double drift_rad_per_sqrt_m = 0.0002;  ///< Over 100 m that is 0.1 degrees; simulated drives show 0.04 to 0.06.
  WheelJumpConfig wheel_jump;
  LocalMapConfig map;
  matching::CorrelativeConfig search;
  sensing::MotionModelConfig motion;
  matching::PointToLineConfig match;
  AmbiguousMatchConfig ambiguous;
  /// Of published covariances; measured by NEES on simulated drives: docs/decisions/0050. Positions err with the way, headings with each scan.
  sensing::PoseErrors pose_errors{.forward = {.of_scan = 0.0002, .of_surprises = 1.6, .of_map = 0.01, .view_m = 0.15},
                                  .sideways = {.of_scan = 0.0005, .of_surprises = 2.1, .of_map = 0.0, .view_m = 0.03},
                                  .heading = {.of_scan = 0.019, .of_surprises = 0.03, .of_map = 0.0, .view_m = 0.1}};
};

/// What happened so far; all grow only.
struct LocalizerCounters {
  std::uint64_t scans = 0;
  std::uint64_t duplicate_scans = 0;      ///< Same scanner and stamp as one before: dropped.
  std::uint64_t out_of_order_scans = 0;   ///< Older than one before: dropped.
  std::uint64_t far_ahead_scans = 0;      ///< Stamped far ahead of those before, and no second one agreed: dropped.
  std::uint64_t too_few_echoes = 0;       ///< Dead reckoning instead of a match.
  std::uint64_t lost_matches = 0;         ///< Too few points matched: dead reckoning.
  std::uint64_t searches = 0;             ///< Correlative searches.
  std::uint64_t sampled_matches = 0;      ///< Along some direction the scan said too little: SCRIM.
  std::uint64_t found_again = 0;          ///< Searches after a lost match that found the pose in the local map.
  std::uint64_t astray = 0;               ///< Maps begun because it was not found there.
  std::uint64_t withheld_scans = 0;       ///< Not put into the map: it was not sure enough where they were.
  std::uint64_t odometry_jumps = 0;       ///< Steps taken at constant velocity instead.
  std::uint64_t without_odometry = 0;
  std::uint64_t gaps = 0;                 ///< Steps longer than longest_step_s.
  std::uint64_t fallback_integrations = 0;///< Labels came too late or not at all.
  std::uint64_t restored_points = 0;      ///< Given back by tracking.
  std::uint64_t submaps = 0;
};

/// By the names of the members, as reports and statuses show them.
inline std::map<std::string, std::uint64_t> named(const LocalizerCounters& counters) {
  return {{"scans", counters.scans},
          {"duplicate_scans", counters.duplicate_scans},
          {"out_of_order_scans", counters.out_of_order_scans},
          {"far_ahead_scans", counters.far_ahead_scans},
          {"too_few_echoes", counters.too_few_echoes},
          {"lost_matches", counters.lost_matches},
          {"searches", counters.searches},
          {"sampled_matches", counters.sampled_matches},
          {"found_again", counters.found_again},
          {"astray", counters.astray},
          {"withheld_scans", counters.withheld_scans},
          {"odometry_jumps", counters.odometry_jumps},
          {"without_odometry", counters.without_odometry},
          {"gaps", counters.gaps},
          {"fallback_integrations", counters.fallback_integrations},
          {"restored_points", counters.restored_points},
          {"submaps", counters.submaps}};
}

/// Estimates the pose of the vehicle and the map around it, scan by scan. Not thread-safe; reads no clock.
class Localizer {
 public:
  /// help, if any, does what the next match does not need, which is most of mapping, and half of the polar view. The results are the same with it and without.
  /// It must outlive this.
  explicit Localizer(const LocalizerConfig& config, work::SideWork* help = nullptr);

  void add_odometry(const sensing::Odometry& sample);

  /// Whether waiting for more odometry could still improve the prediction at the stamp.
  bool has_odometry_for(std::int64_t stamp_ns) const { return odometry_.reaches(stamp_ns); }

  /// Pose of the scan, its points without the sweep's motion, and what the map expected of each beam.
  /// None for a scan that is a duplicate (of the same scanner and stamp), out of order, or far ahead of all before it. Remembers the scan until its labels come.
  /// done_with is memory for the result: any earlier one that nobody needs any more.
  std::optional<flow::LocalizedScan> localize(const sensing::LaserScan& scan, flow::LocalizedScan done_with = {});

  /// The scan that was localized last, matched once more from the same prediction and against the same map, without the
  /// points that its labels keep out of the SO-map; in place of what was remembered of it. Iterated SLAM with DATMO of Wang 2004, Section 6.2.
  /// None, and nothing changed, where that cannot be or cannot be better: the labels leave out the same points as before or
  /// too many for a match that is believed, it is the first scan, the vehicle is or was lost, it has been integrated, or another came since.
  std::optional<flow::LocalizedScan> localize_again(const sensing::LaserScan& scan, const std::vector<flow::PointLabel>& labels);

  /// What tracking says to be there: left out of the next matches. Where one that surely moves is in the scan of which the labels
  /// come next nothing stands.
  void expect(const flow::TrackedObjects& objects);

  /// Labels by detection, used when tracking's do not come.
  void note(const flow::SegmentedScan& segmented);

  /// Whether a scan waits to be integrated.
  bool awaits_labels() const { return !pending_.empty(); }

  /// Adds the scan, and any that still wait before it, to the maps. Unknown scans are ignored.
  void integrate(const flow::ScanLabels& labels);

  /// Submap that was finished since the last call.
  std::optional<flow::Submap> take_finished_submap();

  /// Integrates what still waits and ends the submap in progress, as at the end of a drive. Should the drive go on, the
  /// next scan begins the next submap.
  void finish();

  void correct(const flow::GraphCorrection& correction);

  /// Goes on in a stored map: the drive's first submap follows the map's last one and is tied to it by next to nothing.
  /// Loop closing looks for where it lies; until then poses in map begin where that last one is. To be told again, as the
  /// map comes to be known, until the first scan; later it changes nothing.
  void go_on_after(const flow::CorrectedSubmap& last);

  /// Whether scans fit the local map, or its place in it is looked for.
  bool is_lost() const { return progress_.lost_scans > 0; }

  const geometry::Pose2& map_from_odom() const { return map_from_odom_; }
  const sensing::MotionCalibration& calibration() const { return progress_.estimate.calibration; }
  /// By how much later than the scans odometry is stamped, as believed, and whether that is certain enough to be used.
  double stamp_offset_s() const { return sensing::stamp_offset_s(of_stamps()); }
  double stamp_offset_sigma_s() const { return std::sqrt(of_stamps().covariance(sensing::kStampOffset, sensing::kStampOffset)); }
  bool applies_stamp_offset() const { return progress_.applies_stamp_offset; }
  const SweepFactor& sweep_factor() const { return progress_.sweep_factor; }
  const LocalizerCounters& counters() const { return progress_.counters; }
  const LocalMap& local_map() const { return map_; }

  /// Everything that is needed to go on after a crash, in a form of this build; empty before the first scan. Scans that
  /// wait for their labels, and what tracking expects, are not in it.
  std::vector<std::byte> checkpoint() const;
  /// Odometry that came before the first scan is kept. False, and nothing changed, when the bytes are damaged or the map in them has another shape than this configuration's.
  bool restore(std::span<const std::byte> bytes);

 private:
  struct State {
    std::int64_t stamp_ns = 0;
    bool has_wheels = false;
    geometry::Pose2 wheel_from_base;
    bool knows_velocity = false;    ///< Not at the first scan.
    bool was_sampled = false;       ///< Its match left some direction to the prediction.
    double speed_mps = 0.0;
    double yaw_rate_radps = 0.0;
    bool doubted_wheels = false;    ///< What they said last was a jump.
    double trusted_s = 0.0;         ///< For how long they have said no such thing.
    double stood_s = 0.0;           ///< For how long they have said nothing but that they stand.
  };

  struct Match {
    geometry::UncertainPose2 odom_from_base;
    bool is_believed = false;       ///< Otherwise it is the prediction.
    bool was_sampled = false;       ///< It left some direction to the prediction.
    bool is_lost = false;           ///< There were enough points, and they did not match.
    double rms_residual_m = 0.0;    ///< Of a believed one.
    double new_share = 0.0;         ///< How much of the map it was matched against is new; 0 where it left some direction to the prediction: that the map says nothing of.
  };

  static constexpr std::size_t kScansKeptForRestoring = 80;
  struct PendingScan {
    bool is_withheld = false;                   ///< From the map,
    bool is_doubted = false;                    ///< or only until it is clear whether the vehicle is lost.
    std::int64_t stamp_ns = 0;
    std::uint32_t sequence = 0;
    std::string scanner_id;
    double beam_step_rad = 0.0;
    geometry::Vector2 origin_in_odom_m;
    std::vector<grids::Ray> rays;               ///< Ends in odom; as if all stood of which an echo may go into the map.
    std::vector<flow::EndCell> end_cells;
    std::vector<flow::PointLabel> fallback;     ///< By detection; empty when it has said nothing.
  };

  struct Step {
    sensing::MotionEstimate after;
    geometry::Pose2 before_from_base;
    bool is_by_wheels = false;
    double stood_s = 0.0;           ///< For how long the wheels have said nothing but that they stand;
    bool is_standing = false;       ///< for a while.
    bool has_doubted_wheels = false;
    double duration_s = 0.0;
  };

  /// What a scan changes when it is localized: all that must be as before to do it again.
  struct Progress {
    sensing::MotionEstimate estimate;               ///< Of one clock for scans and odometry, until applies_stamp_offset.
    sensing::MotionEstimate with_stamp_offset;      ///< Of the same motion, until then: what it would be with the offset learned.
    bool applies_stamp_offset = false;
    sensing::VarianceFactors variance_factors;
    sensing::MapChange map_change;
    SweepFactor sweep_factor;
    std::optional<State> last;
    geometry::Matrix3 drift = geometry::Matrix3::Zero();  ///< Covariance of what was travelled in this submap, for the tie to the next.
    double travelled_m = 0.0;                       ///< In this submap.
    std::optional<std::int64_t> lost_since_ns;      ///< Stamp of the first scan that did not match.
    int lost_scans = 0;                             ///< Since wheels are no longer trusted.
    int scans_to_prove = 0;                         ///< Until it is believed to have found itself again.
    bool contradicts_map = false;                   ///< The scan at hand, where it was matched.
    std::optional<double> explained_before = 0.0;   ///< Share of the last scan's points that the map explained; none: not asked.
    bool everything_changed = false;                ///< From one scan to the next, when it was lost.
    LocalizerCounters counters;
  };

  bool is_usable(const sensing::LaserScan& scan);
  void begin(const sensing::LaserScan& scan);
  static State state_at(std::int64_t stamp_ns, const std::optional<geometry::Pose2>& wheel_from_base);
  bool place(const sensing::LaserScan& scan);
  bool can_be_placed_again(const sensing::LaserScan& scan, const std::vector<flow::PointLabel>& labels) const;
  std::vector<std::size_t> kept_out(const std::vector<flow::PointLabel>& labels) const;
  std::optional<geometry::Pose2> wheel_from_base_at(std::int64_t stamp_ns) const;
  std::optional<geometry::Pose2> wheel_step(std::int64_t stamp_ns, std::int64_t after_ns) const;
  Eigen::Vector3d step_by_stamp_offset(std::int64_t stamp_ns, double offset_s) const;
  bool have_jumped_lately() const;
  bool tells_of_stamps(std::int64_t stamp_ns) const;
  void renew_map(const geometry::Pose2& before_from_base, const Match& found);
  void watch_stamps(std::int64_t stamp_ns, const Step& step, const Match& found);
  static bool is_still(const geometry::Pose2& by_wheels, double duration_s);
  Step predict(std::int64_t stamp_ns, const std::optional<geometry::Pose2>& wheel_from_base);
  sensing::MotionEstimate moved_by_wheels(const geometry::Pose2& by_wheels, std::int64_t stamp_ns, double duration_s) const;
  bool is_impossible(const geometry::Pose2& by_wheels, double duration_s) const;
  bool is_doubtful(const geometry::Pose2& by_wheels, double duration_s) const;
  sensing::MotionEstimate doubted_velocity(const geometry::Pose2& by_wheels, double duration_s) const;
  Match match(const geometry::UncertainPose2& prior, const matching::PointToLineConfig& config, std::uint32_t scan_sequence);
  matching::PointToLineResult match_in_closed_form(const geometry::UncertainPose2& prior, const matching::PointToLineConfig& config);
  const matching::PointToLineConfig& match_config(const Step& step, const State& now) const;
  Match match_or_find(const geometry::UncertainPose2& prior, const sensing::LaserScan& scan, bool has_wheels, const matching::PointToLineConfig& config);
  std::optional<Match> find_again(const geometry::UncertainPose2& prior, const matching::PointToLineConfig& config);
  /// Of some of the scan's points, how many lie where.
  struct Contradiction {
    int behind_walls = 0;
    int in_free_space = 0;      ///< Where the map has seen through.
    int explained = 0;
    double share_of_known(int points) const;
    double share() const { return share_of_known(behind_walls + in_free_space); }
    double share_behind_walls() const { return share_of_known(behind_walls); }
  };

  bool is_contradicted(const Match& found, const geometry::UncertainPose2& prior, bool has_wheels);
  double explained_share(const std::vector<matching::MatchPoint>& points, const geometry::Pose2& odom_from_base) const;
  Contradiction contradiction(const geometry::Pose2& odom_from_base) const;
  bool has_gone_astray(std::int64_t stamp_ns) const;
  void begin_astray_submap();
  geometry::UncertainPose2 anywhere_about(const geometry::Pose2& pose) const;
  bool is_vague(const geometry::UncertainPose2& prior) const;
  geometry::Pose2 search(const geometry::UncertainPose2& prior);
  std::vector<matching::Peak> peaks_around(const geometry::UncertainPose2& prior, matching::CorrelativeMatcher& searcher);
  static matching::CorrelativeConfig finder_config(matching::CorrelativeConfig search);
  void select_points(const sensing::LaserScan& scan, const geometry::Pose2& odom_from_base);
  bool learns_sweep(const sensing::LaserScan& scan) const;
  double true_sweep_s(const sensing::LaserScan& scan) const;  ///< As learned, where it is.
  const sensing::LaserScan& with_true_sweep(const sensing::LaserScan& scan);
  void learn_sweep(const sensing::LaserScan& scan, const geometry::UncertainPose2& prior, const geometry::Pose2& odom_from_base, const State& now);
  void mask_expected_objects(std::int64_t stamp_ns);
  bool is_masked(const geometry::Vector2& point_in_odom_m) const;
  void travel(const geometry::Pose2& before_from_base, double duration_s);
  geometry::UncertainPose2 published_pose() const;
  flow::LocalizedScan describe(const sensing::LaserScan& scan, const geometry::UncertainPose2& odom_from_base, flow::LocalizedScan done_with);
  void list_asked_beams(const flow::LocalizedScan& localized);
  void remember(const sensing::LaserScan& scan, const flow::LocalizedScan& localized);
  void integrate_first(const std::vector<flow::PointLabel>* labels);
  void integrate(PendingScan& scan);
  void integrate_doubted();
  void drop_doubted();
  void integrate_first_without_tracking();
  void integrate_overdue(std::int64_t now_ns);
  void restore_points(const flow::ScanLabels& labels);
  void free_bodies(const flow::ScanLabels& labels);
  void begin_next_submap_if_due();
  void end_submap();

  /// The one list of what a checkpoint holds before the map, in its order.
  template <typename Self, typename StateOfLast, typename Visitor>
  static void for_each_part(Self& self, StateOfLast& last, Visitor visit);

  const sensing::MotionEstimate& of_stamps() const { return progress_.applies_stamp_offset ? progress_.estimate : progress_.with_stamp_offset; }

  LocalizerConfig config_;
  work::SideWork* help_ = nullptr;
  sensing::MotionModelConfig motion_of_one_clock_;         ///< That of the estimate until the stamps' offset is used.
  matching::PointToLineConfig match_without_wheels_;       ///< For a step of which wheels say nothing: nothing but the scan tells of it.
  matching::PointToLineConfig match_by_scans_alone_;       ///< Where there are no wheels at all.
  sensing::StampGuard scan_stamps_;
  sensing::StampGuard odometry_stamps_;
  sensing::OdometryBuffer odometry_;
  Progress progress_;
  std::optional<Progress> before_scan_;              ///< Before the last one, while it may be localized again.
  std::vector<std::string> scanners_at_last_;        ///< Whose scans have the last stamp; empty after a restore.
  LocalMap map_;
  flow::SubmapId first_submap_;
  geometry::Pose2 map_from_odom_;
  geometry::UncertainPose2 previous_from_submap_;    ///< Of the submap in progress.
  bool submap_is_ended_ = false;                     ///< And the next one not yet begun.
  std::int32_t short_submaps_left_ = 0;              ///< After it has gone astray.
  std::uint32_t correction_sequence_ = 0;
  flow::TrackedObjects expected_objects_;
  memory::Spares<flow::TrackedObject> spare_objects_;
  memory::RecyclingQueue<PendingScan> pending_;
  std::vector<PendingScan> doubted_;
  memory::RecyclingQueue<PendingScan> integrated_{kScansKeptForRestoring};   ///< The last ones, for points that tracking gives back.
  std::vector<flow::Submap> finished_;
  matching::CorrelativeMatcher searcher_;
  matching::CorrelativeMatcher finder_;              ///< After a lost match: of several poses.
  matching::PointToLineMatcher matcher_;
  AmbiguousMatcher ambiguous_matcher_;
  std::vector<geometry::Vector2> points_in_base_m_;  ///< Of the scan at hand; kept to reuse the memory.
  std::vector<geometry::Vector2> beams_in_odom_;     ///< Unit vectors, of the scan at hand,
  std::vector<std::size_t> asked_beams_;             ///< and of which of its beams it is asked how far the map would have let them go.
  geometry::Vector2 laser_in_base_m_ = geometry::Vector2::Zero();  ///< Of the scan at hand.
  std::vector<matching::MatchPoint> match_points_;
  std::vector<matching::MatchPoint> match_points_before_;  ///< Of the scan before.
  std::vector<std::size_t> candidate_beams_;         ///< Whose echoes would be matched if labels left out none,
  std::vector<std::size_t> left_out_beams_;          ///< and those of them that labels leave out; ascending, as they are.
  sensing::LaserScan swept_scan_;                    ///< The scan at hand with its sweep as it is believed to be.
  std::vector<double> share_of_sweep_;               ///< By match point, where the sweep is learned.
  std::vector<grids::Box> masks_;  ///< Of what moves, in odom.
};

}  // namespace slammot::localization
