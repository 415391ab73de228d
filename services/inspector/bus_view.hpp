#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/dds/any_reader.hpp"
#include "common/dds/discovery.hpp"
#include "common/dds/participant.hpp"
#include "services/inspector/bus_options.hpp"
#include "services/inspector/topic_meter.hpp"

namespace slammot::inspector {

/// A topic that is measured.
struct WatchedTopic {
  dds::AnyReader reader;
  TopicMeter meter;
};

/// All topics of a bus, known to this program or not, as an observer sees them.
class BusView {
 public:
  /// Waits until everybody has been discovered, at most the options' patience.
  explicit BusView(const BusOptions& options);

  /// Receives for this time; begins to watch topics that appear meanwhile, if `watches_all`.
  void receive(std::chrono::milliseconds duration, bool watches_all);

  /// Begins to watch a topic that has an endpoint; false if its type cannot be learnt.
  bool watch(const std::string& topic);
  /// Called with each sample of a watched topic, in addition to the meter.
  void on_sample(std::function<void(const std::string&, const dds::AnySample&)> handle) {
    on_sample_ = std::move(handle);
  }

  const dds::Discovery& discovery() const { return discovery_; }
  const dds::Participant& participant() const { return participant_; }
  std::map<std::string, WatchedTopic>& topics() { return topics_; }
  /// Names of all topics that have an endpoint.
  std::set<std::string> topic_names() const;

 private:
  void watch_new_topics();
  void take_all();

  dds::Participant participant_;
  dds::Discovery discovery_;
  std::map<std::string, WatchedTopic> topics_;
  std::set<std::string> unreadable_;
  std::function<void(const std::string&, const dds::AnySample&)> on_sample_;
};

}  // namespace slammot::inspector
