#pragma once

#include <map>
#include <utility>
#include <vector>

#include "common/filters/formation.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Vehicles that drive in a queue, tracked as one system beside their own filters (Wang 2004, Section 4.7). Whoever is seen
/// keeps the estimate of its own filter; whoever is not, behind something else, goes on as the others do.
class Formations {
 public:
  explicit Formations(const TrackingConfig& config) : config_(config) {}

  /// Takes the tracks as they are after a scan, time_s (>= 0) after the one before, and moves those of members unseen in it.
  void follow(std::vector<Track>& tracks, double time_s);

 private:
  struct Formation {
    std::vector<flow::TrackId> members;  ///< Ascending; of the state's members in order.
    filters::FormationState state;
  };
  using Pair = std::pair<flow::TrackId, flow::TrackId>;

  void note_pairs(const std::vector<Track>& tracks, double time_s);
  std::vector<std::vector<flow::TrackId>> groups(const std::vector<Track>& tracks) const;
  Formation initiated(const std::vector<flow::TrackId>& members, const std::vector<Track>& tracks) const;
  void step(Formation& formation, std::vector<Track>& tracks, double time_s) const;

  TrackingConfig config_;
  std::map<Pair, double> alike_s_;       ///< For how long two have been seen to go alike.
  std::vector<Formation> formations_;
};

}  // namespace slammot::tracking
