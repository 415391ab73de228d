#pragma once

#include <map>
#include <vector>

#include "common/flow/submap.hpp"
#include "common/traffic/traffic_collector.hpp"
#include "common/traffic/traffic_map.hpp"

namespace slammot::traffic {

/// What moved while each submap was in use, in the submap's frame.
using SubmapTraffic = std::map<flow::SubmapId, std::vector<FreeStream>>;

/// Traffic of a map under the numbers that its submaps have in another one: the first of `submaps`
/// is `first` there, and they follow each other. Traffic of other submaps is left out.
SubmapTraffic renumbered(const SubmapTraffic& traffic, const std::vector<flow::Submap>& submaps,
                         flow::SubmapId first);

/// Collects the traffic of a drive by submap, as map_store does on the bus.
class TrafficOfDrive {
 public:
  void take(const flow::TrackedObjects& objects) { collector_.add(objects); }

  /// Of a submap that ended just now.
  void finish(const flow::Submap& submap);

  const SubmapTraffic& by_submap() const { return by_submap_; }

 private:
  TrafficCollector collector_;
  SubmapTraffic by_submap_;
};

}  // namespace slammot::traffic
