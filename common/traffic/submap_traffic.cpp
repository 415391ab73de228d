#include "common/traffic/submap_traffic.hpp"

#include <utility>

namespace slammot::traffic {

SubmapTraffic renumbered(const SubmapTraffic& traffic, const std::vector<flow::Submap>& submaps,
                         flow::SubmapId first) {
  SubmapTraffic renumbered;
  flow::SubmapId number = first;
  for (const flow::Submap& submap : submaps) {
    const auto known = traffic.find(submap.submap_id);
    if (known != traffic.end()) renumbered.emplace(number, known->second);
    ++number.value;
  }
  return renumbered;
}

void TrafficOfDrive::finish(const flow::Submap& submap) {
  std::vector<FreeStream> streams = collector_.take(submap);
  if (streams.empty()) return;
  std::vector<FreeStream>& known = by_submap_[submap.submap_id];
  known.insert(known.end(), streams.begin(), streams.end());
}

}  // namespace slammot::traffic
