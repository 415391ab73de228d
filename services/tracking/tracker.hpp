#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/flow/segmented_scan.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/stages/tracking_stage.hpp"
#include "common/work/side_work.hpp"
#include "services/tracking/association.hpp"
#include "services/tracking/formations.hpp"
#include "services/tracking/road_user_learning.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/scanners.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"
#include "services/tracking/tracking_result.hpp"
#include "services/tracking/workspace.hpp"

namespace slammot::tracking {

/// Tracks moving objects from scan to scan of one vehicle. Deterministic; reads no clock.
/// Association by gating and global nearest neighbour (Wang 2004, Section 5.1) or by several
/// hypotheses (Section 5.2), motion by IMM (Section 2.3) and move-stop hypotheses (Section 4.6),
/// existence by log-odds (Eqs. 5.1-5.5). The extent grows with what is seen, so that the position
/// is the object's centre.
class Tracker final : public stages::TrackingStage {
 public:
  /// help (null: none) must outlive this; the results do not depend on it.
  explicit Tracker(const TrackingConfig& config, work::SideWork* help = nullptr);

  /// Takes one scan; returns the tracks after it and the label of each of its points. Valid until
  /// the next call.
  const TrackingResult& step(const flow::SegmentedScan& scan) override;

  /// Restores tracks from the last published message. Ids are kept and never reused; all other
  /// state is lost.
  void resume(const flow::TrackedObjects& objects);

  /// Appends the complete state: a tracker that restores it gives the same results from then on.
  void save(std::vector<std::byte>& bytes) const;
  /// False, and nothing changes, for bytes that no tracker of this version saved.
  bool restore(std::span<const std::byte> bytes);
  static void visit_state(auto& self, auto& visit);
  /// Leaves out ids that tracks begun after the restored state may have.
  void begin_ids_at(std::uint32_t next_id) { next_id_ = std::max(next_id_, next_id); }
  std::uint32_t next_id() const { return next_id_; }

  std::int64_t last_stamp_ns() const { return scanners_.last_stamp_ns(); }

  const TrackerCounters& counters() const { return counters_; }
  std::map<std::string, std::uint64_t> named_counters() const override { return named(counters_); }

 private:
  /// What lasts from scan to scan beside the tracks.
  struct Estimation {
    Associator associator;
    Formations formations;
    LocalRoadUsers road_users;
    static void visit_state(auto& self, auto& visit) {
      visit(self.associator, self.formations, self.road_users);
    }
  };
  /// What is computed anew in each scan.
  struct CurrentScan {
    ScanView view;
    ScanComparison comparison;
    Associations associations;
    std::vector<Owner> owners;
  };

  bool is_sound() const;
  void begin_result(const flow::SegmentedScan& scan);
  void coast(double time_s);
  void compare(const ScanContext& context);
  void associate(const ComparedScan& context);
  void update(const ComparedScan& context);
  void confirm(Track& track);
  void initiate(const ComparedScan& context);
  void merge(const ComparedScan& context);
  void identify(std::int64_t stamp_ns);
  void remember(const ComparedScan& context);
  void terminate();
  void give_back_points(const Track& track);
  void publish(const flow::SegmentedScan& scan);

  TrackingConfig config_;
  TrackerCounters counters_;
  std::vector<Track> tracks_;
  Scanners scanners_;
  Estimation estimation_;
  CurrentScan current_;
  TrackingResult result_;
  Workspace workspace_;
  std::uint32_t next_id_ = 1;
};

}  // namespace slammot::tracking
