#pragma once

#include <vector>

#include "common/association/assignment.hpp"
#include "services/tracking/associations.hpp"
#include "services/tracking/competing_tracks.hpp"
#include "services/tracking/scan_comparison.hpp"
#include "services/tracking/scan_context.hpp"
#include "services/tracking/track.hpp"

namespace slammot::tracking {

/// Assigns segments to tracks: gating and global nearest neighbour (Wang 2004, Section 5.1) or,
/// where configured, the likeliest of several hypotheses (Section 5.2). Then parts of a box and
/// legs of a pedestrian join their track, and tracks without a segment take the echoes in their
/// place of segments that others share.
class Associator {
 public:
  explicit Associator(const TrackingConfig& config) : competing_tracks_(config) {}

  /// Predicts the hypotheses over time_s; the tracks are predicted by their owner.
  void predict(double time_s) { competing_tracks_.predict(time_s); }

  /// Writes the associations, whose shares must be one a track. A track whose likeliest hypothesis
  /// has changed gets its motion.
  void associate(std::vector<Track>& tracks, const ComparedScan& context,
                 Associations& associations);

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) { visit(self.competing_tracks_); }
  /// False for a state that no scans lead to.
  bool is_sound() const { return competing_tracks_.is_sound(); }

 private:
  void assign_whole_segments(std::vector<Track>& tracks, const ComparedScan& context,
                             Associations& associations);
  void assign_competing_tracks(std::vector<Track>& tracks, const ComparedScan& context,
                               Associations& associations);

  CompetingTracks competing_tracks_;
  association::CostMatrix costs_;
  association::Assigner assigner_;
};

/// True if the segment is stationary and was not of the track a moment ago: it is no part of a
/// moving object.
bool has_other_past(const flow::Segment& segment, const SegmentComparison& comparison,
                    const Track& track, const ScanContext& context);

}  // namespace slammot::tracking
