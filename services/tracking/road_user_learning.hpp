#pragma once

#include <memory>

#include "services/tracking/road_users.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Adds what an ended track tells of the road users of this place: sizes of an oriented box where
/// they are well known, the distance of the echoes from the sides of a vehicle, and the gait of a
/// pedestrian, each if it was followed for long enough.
void learn_from(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

void learn_sizes(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);
void learn_outline_error(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);
void learn_gait(RoadUsersSeen& seen, const Track& track, const TrackingConfig& config);

/// What the ended tracks of this drive tell of the road users here. Tracks refer to it: it stays
/// where it is when this is moved.
class LocalRoadUsers {
 public:
  const RoadUsers& known() const { return *known_; }

  /// Learns from an ended track; takes effect with refresh().
  void learn(const Track& track, const TrackingConfig& config);

  /// Updates what is known if a track has ended since the last call.
  void refresh();

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) {
    visit(self.seen_, *self.known_, self.is_outdated_);
  }

 private:
  RoadUsersSeen seen_;
  std::unique_ptr<RoadUsers> known_ = std::make_unique<RoadUsers>(seen_.known());
  bool is_outdated_ = false;
};

}  // namespace slammot::tracking
