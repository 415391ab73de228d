#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>

#include "common/dds/topic_table.hpp"
#include "common/wire/decoded.hpp"
#include "services/gateway/audience.hpp"
#include "services/gateway/map_publisher.hpp"
#include "services/gateway/scan_pairing.hpp"

namespace slammot::gateway {

/// Makes messages for viewers of what is on the bus about one vehicle.
class DriveMessages {
 public:
  using Time = MapPublisher::Time;
  /// Takes the name of a counter, and why a sample was dropped.
  using Warn = std::function<void(const char* counter, std::string_view line)>;

  DriveMessages(Audience& audience, Warn warn);

  void take(const slammot_LaserScan& sample);
  /// False if it was dropped.
  bool take(const slammot_LocalizedScan& sample);
  void take(const slammot_ScanLabels& sample);
  void take(const slammot_TrackedObjects& sample);
  void take(const slammot_GnssFix& sample);
  void take(const slammot_SubmapTile& tile);
  void take(const slammot_GraphCorrection& part);
  void take(const slammot_Constraint& sample);
  void take(const slammot_TrafficWays& part);

  /// Publishes what changed of the map. Call it a few times a second.
  void publish_map(Time now) { map_.publish(now); }
  /// Waits until what has been taken is made: the next publish_map() has it.
  void finish_map() { map_.finish(); }

 private:
  template <typename Value>
  bool accept(const wire::Decoded<Value>& decoded, const char* counter);
  void note_fault(const char* counter, std::string_view fault);

  Audience& audience_;
  Warn warn_;
  ScanPairing pairing_;
  MapPublisher map_;
  std::set<flow::TrackId> shown_tracks_;
};

}  // namespace slammot::gateway
