#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/association/assignment.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/memory/spares.hpp"
#include "common/work/side_work.hpp"
#include "services/tracking/formations.hpp"
#include "services/tracking/competing_tracks.hpp"
#include "services/tracking/road_users.hpp"
#include "services/tracking/scan_history.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

struct TrackingResult {
  flow::TrackedObjects objects;
  flow::ScanLabels labels;
};

/// What happened so far; all grow only.
struct TrackerCounters {
  std::uint64_t scans = 0;
  std::uint64_t late_scans = 0;       ///< Older than one before: labelled as detection did, nothing tracked.
  std::uint64_t tracks_begun = 0;
  std::uint64_t tracks_confirmed = 0;
  std::uint64_t tracks_merged = 0;
  std::uint64_t tracks_rejected = 0;  ///< Never confirmed; their points were given back.
  std::uint64_t points_restored = 0;
};

/// By the names of the members, as reports and statuses show them.
inline std::map<std::string, std::uint64_t> named(const TrackerCounters& counters) {
  return {{"scans", counters.scans},
          {"late_scans", counters.late_scans},
          {"tracks_begun", counters.tracks_begun},
          {"tracks_confirmed", counters.tracks_confirmed},
          {"tracks_merged", counters.tracks_merged},
          {"tracks_rejected", counters.tracks_rejected},
          {"points_restored", counters.points_restored}};
}

/// Follows moving objects from scan to scan of one vehicle. Deterministic; reads no clock.
/// Association by gating and global nearest neighbour (Wang 2004, Section 5.1), or by several hypotheses where the settings say
/// so (Section 5.2), motion by IMM (Section 2.3) and move-stop hypotheses (Section 4.6), existence by the object score
/// (Eqs. 5.1-5.5); bodies grow with what is seen of them, so that the position is the object's centre.
class Tracker {
 public:
  /// help (null: none) must outlive this; the results are the same with it and without.
  explicit Tracker(const TrackingConfig& config, work::SideWork* help = nullptr);

  /// Takes one scan and tells what is believed after it, and what each of its points is. done_with: a result that nobody needs any
  /// more; of it nothing but memory is used. Given back one, this allocates nothing while no more is in view than ever was.
  TrackingResult track(const flow::SegmentedScan& scan, TrackingResult done_with = {});

  /// Goes on with what was published last, after a restart: ids stay and are not given again. Forgets all else.
  void resume(const flow::TrackedObjects& objects);

  const TrackerCounters& counters() const { return counters_; }

 private:
  /// Which segments, and which of their beams, belong to which track.
  struct Shares {
    std::vector<std::vector<std::uint16_t>> beams_of_track;
    std::vector<flow::PointLabel> label_of_track;  ///< Moving if any of its segments does, else stationary if any is.
    std::vector<std::size_t> track_of_segment;     ///< kUnassigned where none.
  };
  /// What comparing with an earlier scan says of a segment.
  struct SegmentPast {
    int stood = 0;
    int arrived = 0;
    int receded = 0;
    int came = 0;               ///< Arrived or appeared since then or, where that is not known, in the last moments.
    int longest_arrival = 0;    ///< Neighbouring echoes that arrived: a face that comes, while its flank slides along itself.
    Eigen::Vector2d face_shift_m = Eigen::Vector2d::Zero();  ///< By which its front or rear has moved, where that shows.
    bool stood_before = false;  ///< By the earlier scan,
    bool stands = false;        ///< or by the map.
    bool has_come = false;      ///< It is where a vehicle was that has come there: the same, standing.
  };

  /// What is kept for each scanner: what one sees is compared with what it saw itself, and answered to it.
  struct OfScanner {
    std::string scanner_id;
    ScanHistory history;
    std::vector<flow::RestoredPoints> restored;   ///< To be told with the labels of its next scan.
  };

  /// What a scan is compared with.
  struct PastScans {
    const EarlierScan* then = nullptr;
    const EarlierScan* just_now = nullptr;
    const EarlierScan* long_ago = nullptr;
    std::array<const EarlierScan*, 5> for_faces{};   ///< Of which the first so many are there.
    std::size_t count_for_faces = 0;
  };
  /// What has become of a track when its echoes were taken.
  enum class Outcome : std::uint8_t { kGoesOn, kIsOfSomethingElse, kIsConfirmed };

  const ScanHistory& history() const { return scanners_[scanner_].history; }
  bool is_late(const flow::SegmentedScan& scan) const;
  void begin_scan(const flow::SegmentedScan& scan);
  bool is_left_to_another_scanner(const Track& track, const Visibility& visibility) const;
  void restore(const Track& track, flow::ScanLabels& labels);
  PastScans past_scans(std::int64_t stamp_ns) const;
  void compare_with_past(const ScanView& view);
  void compare_with_past(std::size_t segment, const PastScans& past_scans, const ScanView& view);
  void note_face_shift(std::size_t segment, const PastScans& past_scans, const ScanView& view);
  bool may_begin(const flow::Segment& segment, std::size_t index) const;
  bool slides_along_itself(std::uint16_t beam, const Track& track, const ScanView& view) const;
  MotionEvidence evidence_of(std::size_t track, const ScanView& view) const;
  TentativeEvidence with_echoes(TentativeEvidence observations, const std::vector<std::uint16_t>& beams, const ScanView& view) const;
  MotionEvidence evidence_against(const EarlierScan& then, std::size_t track, const ScanView& view) const;
  void check_velocity(std::size_t track, const Observation& observation, const ScanView& view);
  void correct_all(const ScanView& view);
  bool takes(std::size_t track, const Observation& observation, double time_s, const flow::SegmentedScan& scan);
  Outcome correct(std::size_t track, const ScanView& view);
  void confirm(std::size_t track);
  void leave_out_surroundings(std::size_t track, double time_s, const ScanView& view);
  void release(std::size_t track);
  void remember(const ScanView& view);
  bool lies_in_body(const flow::Segment& segment, const Track& track, const ScanView& view) const;
  bool is_of_another_past(std::size_t segment, std::size_t track, const ScanView& view) const;
  bool is_leg(const flow::Segment& segment, const Track& track) const;
  void associate(const ScanView& view);
  void assign_competing_tracks(const ScanView& view, association::CostMatrix& costs);
  void give_whole_segments(const ScanView& view);
  void divide_shared_segments(const ScanView& view);
  void begin_tracks(const ScanView& view);
  void absorb(std::size_t a, std::size_t b);
  void join_pieces(const ScanView& view);
  void merge_duplicates();
  void remove_dead(flow::ScanLabels& labels);
  void label(const ScanView& view, flow::ScanLabels& labels);
  void describe(const flow::SegmentedScan& scan, flow::TrackedObjects& objects);

  TrackingConfig config_;
  work::SideWork* help_;
  TrackerCounters counters_;
  std::vector<Track> tracks_;
  Shares shares_;
  std::vector<Past> past_of_beam_;              ///< Of the current scan.
  std::vector<SegmentPast> past_of_segment_;
  std::vector<std::vector<Eigen::Vector2d>> observed_points_m_;  ///< Of each track while it is being corrected.
  std::vector<Outcome> outcomes_;               ///< Of each track, when it was.
  std::vector<char> has_shifted_;               ///< Beams on faces that have moved.
  RoadUsersSeen road_users_seen_;               ///< Each when its track ended.
  std::unique_ptr<RoadUsers> road_users_ = std::make_unique<RoadUsers>(road_users_seen_.known());  ///< Where it is when the tracker is moved: tracks refer to it.
  CompetingTracks competing_tracks_;
  Formations formations_;
  std::vector<OfScanner> scanners_;             ///< In the order of their first scans.
  std::size_t scanner_ = 0;                     ///< That of the current scan.
  std::vector<std::size_t> scanners_at_last_;   ///< Whose scans have the last stamp; empty after a restart.
  /// Memory that is used again.
  ScanView view_;                               ///< Of the current scan.
  std::vector<Owner> owners_;
  std::vector<Eigen::Vector2d> points_m_;
  association::CostMatrix costs_;
  association::Assigner assigner_;
  memory::Spares<Track> spare_tracks_;
  memory::Spares<std::vector<std::uint16_t>> spare_beams_;
  memory::Spares<flow::TrackedObject> spare_objects_;
  memory::Spares<flow::RestoredPoints> spare_restored_;
  std::uint32_t next_id_ = 1;
  std::int64_t last_stamp_ns_ = 0;
  bool has_scan_ = false;
};

}  // namespace slammot::tracking
