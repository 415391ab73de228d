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

/// How a track moves in one hypothesis of which segments were its own.
struct HypothesisMotion {
  filters::ImmState predicted;        ///< To the current scan,
  filters::ImmState motion;           ///< and with the segment that it has there.
  filters::MotionState estimate;      ///< Of `motion`, its modes together.
};

/// Whose segments are whose among those who walk close to one another: confirmed tracks without sides, each cluster of which
/// is kept in several hypotheses (Wang 2004, Section 5.2). Hypotheses differ in motion only; body, score and evidence are the
/// tracks' own, and follow what was likeliest.
class CompetingTracks {
 public:
  explicit CompetingTracks(const TrackingConfig& config);

  /// Predicts what is supposed; the tracks are predicted by whoever owns them.
  void predict(double time_s);

  /// Segment of each track, kUnassigned for none and for tracks of which nothing is supposed. Tracks in whose place another
  /// past has become likelier move as that says from now on. may_have(track, segment): what the history allows.
  std::vector<std::size_t> decide(std::vector<Track>& tracks, const ScanView& view,
                                  const std::function<bool(std::size_t track, std::size_t segment)>& may_have);

  /// Whether anything is supposed of the track.
  bool has(const Track& track) const { return hypotheses_.has(track.track_id.value); }

 private:
  void keep_up(const std::vector<Track>& tracks);

  TrackingConfig config_;
  association::MultipleHypotheses<HypothesisMotion> hypotheses_;
};

}  // namespace slammot::tracking
