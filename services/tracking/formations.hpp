#pragma once

#include <map>
#include <utility>
#include <vector>

#include "common/filters/formation.hpp"
#include "services/tracking/track.hpp"
#include "services/tracking/tracking_config.hpp"

namespace slammot::tracking {

/// Vehicles in a queue, tracked as one system beside their own filters (Wang 2004, Section 4.7). An
/// observed member keeps the estimate of its own filter; a hidden one follows the others.
class Formations {
 public:
  explicit Formations(const TrackingConfig& config) : config_(config) {}

  /// Updates the formations by the tracks after a scan, time_s (>= 0) after the one before, and
  /// moves the members not observed in it.
  void follow(std::vector<Track>& tracks, double time_s);

  /// Lists what lasts from scan to scan, to save and load it (memory::StateVisitor).
  static void visit_state(auto& self, auto& visit) { visit(self.alike_s_, self.formations_); }
  /// False for a state that does not go with these tracks.
  bool is_sound_with(const std::vector<Track>& tracks) const;

 private:
  struct Formation {
    std::vector<flow::TrackId> members;  ///< Ascending; in the order of the state's members.
    filters::FormationState state;
    static void visit_state(auto& self, auto& visit) {
      visit(self.members, self.state.mean, self.state.covariance);
    }
  };
  using Pair = std::pair<flow::TrackId, flow::TrackId>;

  void note_pairs(const std::vector<Track>& tracks, double time_s);
  std::vector<std::vector<flow::TrackId>> groups(const std::vector<Track>& tracks) const;
  Formation initiated(const std::vector<flow::TrackId>& members,
                      const std::vector<Track>& tracks) const;
  void step(Formation& formation, std::vector<Track>& tracks, double time_s) const;

  TrackingConfig config_;
  std::map<Pair, double> alike_s_;  ///< How long two tracks have moved alike.
  std::vector<Formation> formations_;
};

}  // namespace slammot::tracking
