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
#include "services/localization/localizer_config.hpp"
#include "services/localization/localizer_counters.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/published_covariance.hpp"
#include "services/localization/sweep_estimate.hpp"

namespace slammot::localization {

/// Estimates the pose of the vehicle and the map around it, scan by scan. Not thread-safe; reads no clock.
class Localizer {
 public:
  /// help, if any, does what the next match does not need, which is most of mapping, and half of the polar view. The results are the same with it and without.
  /// It must outlive this.
  explicit Localizer(const LocalizerConfig& config, work::SideWork* help = nullptr);

  void add_odometry(const sensing::Odometry& sample);

  /// Whether waiting for more odometry could still improve the prediction at the stamp.
  bool has_odometry_for(std::int64_t stamp_ns) const { return prediction_.reaches(stamp_ns); }

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
  const sensing::MotionCalibration& calibration() const { return prediction_.estimate().calibration; }
  /// By how much later than the scans odometry is stamped, as believed, and whether that is certain enough to be used.
  double stamp_offset_s() const { return prediction_.stamp_offset_s(); }
  double stamp_offset_sigma_s() const { return prediction_.stamp_offset_sigma_s(); }
  bool applies_stamp_offset() const { return prediction_.state().applies_stamp_offset; }
  const SweepFactor& sweep_factor() const { return progress_.sweep_factor; }
  const LocalizerCounters& counters() const { return progress_.counters; }
  const LocalMap& local_map() const { return map_; }

  /// Everything that is needed to go on after a crash, in a form of this build; empty before the first scan. Scans that
  /// wait for their labels, and what tracking expects, are not in it.
  std::vector<std::byte> checkpoint() const;
  /// Odometry that came before the first scan is kept. False, and nothing changed, when the bytes are damaged or the map in them has another shape than this configuration's.
  bool restore(std::span<const std::byte> bytes);

 private:
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

  /// What a scan changes when it is localized: all that must be as before to do it again.
  struct Progress {
    OdometryPrediction::State prediction;
    PublishedCovariance::State covariance;
    SweepFactor sweep_factor;
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
  bool place(const sensing::LaserScan& scan);
  bool can_be_placed_again(const sensing::LaserScan& scan, const std::vector<flow::PointLabel>& labels) const;
  std::vector<std::size_t> kept_out(const std::vector<flow::PointLabel>& labels) const;
  ScanMatch match(const Step& step, std::uint32_t scan_sequence);
  matching::PointToLineResult match_in_closed_form(const Step& step);
  const matching::PointToLineConfig& match_config(StepSource source) const;
  ScanMatch match_or_find(const Step& step, const sensing::LaserScan& scan);
  std::optional<ScanMatch> find_again(const Step& step);
  /// Of some of the scan's points, how many lie where.
  struct Contradiction {
    int behind_walls = 0;
    int in_free_space = 0;      ///< Where the map has seen through.
    int explained = 0;
    double share_of_known(int points) const;
    double share() const { return share_of_known(behind_walls + in_free_space); }
    double share_behind_walls() const { return share_of_known(behind_walls); }
  };

  bool is_contradicted(const ScanMatch& found, const Step& step);
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
  void learn_sweep(const sensing::LaserScan& scan, const Step& step, const ScanMatch& found);
  void mask_expected_objects(std::int64_t stamp_ns);
  bool is_masked(const geometry::Vector2& point_in_odom_m) const;
  void travel(const geometry::Pose2& before_from_base);
  Progress progress() const;
  void return_to(const Progress& progress);
  void count(const Step& step);
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
  template <typename Self, typename State, typename Visitor>
  static void for_each_part(Self& self, State& progress, Visitor visit);

  LocalizerConfig config_;
  work::SideWork* help_ = nullptr;
  matching::PointToLineConfig match_without_wheels_;       ///< For a step of which wheels say nothing: nothing but the scan tells of it.
  matching::PointToLineConfig match_by_scans_alone_;       ///< Where there are no wheels at all.
  sensing::StampGuard scan_stamps_;
  OdometryPrediction prediction_;
  PublishedCovariance covariance_;
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
