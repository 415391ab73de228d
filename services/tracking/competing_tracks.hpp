#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "common/association/multiple_hypotheses.hpp"
#include "common/filters/imm.hpp"
#include "services/tracking/scan_view.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Motion of a track under one hypothesis of which segments were its own.
struct HypothesisMotion {
  filters::ImmState predicted;    ///< To the current scan.
  filters::ImmState motion;       ///< After the update by its segment there.
  filters::MotionState estimate;  ///< Moment-matched, of `motion`.
};

/// Association by multiple hypotheses (Wang 2004, Section 5.2) among confirmed blobs, mostly
/// pedestrians, that are close to each other: each cluster has several hypotheses. Hypotheses
/// differ in motion only; extent, score and evidence follow the likeliest.
class CompetingTracks {
 public:
  explicit CompetingTracks(const TrackingConfig& config);

  /// Predicts the hypotheses; the tracks are predicted by their owner.
  void predict(double time_s);

  /// Segment of each track; kUnassigned for none, and for tracks that do not compete. A track of
  /// which another past has become likelier gets the motion of that. is_allowed(track, segment):
  /// what the comparison with earlier scans allows.
  std::vector<std::size_t> decide(
      std::vector<Track>& tracks, const ScanView& view,
      const std::function<bool(std::size_t track, std::size_t segment)>& is_allowed);

  /// True if the track competes.
  bool has(const Track& track) const { return hypotheses_.has(track.track_id.value); }

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) { visit(self.hypotheses_); }
  /// False for a state that no scans lead to.
  bool is_sound() const { return hypotheses_.is_sound(); }

 private:
  void synchronise(const std::vector<Track>& tracks);

  TrackingConfig config_;
  association::MultipleHypotheses<HypothesisMotion> hypotheses_;
};

}  // namespace slammot::tracking
