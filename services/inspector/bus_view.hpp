#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "common/dds/discovery.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/raw_reader.hpp"
#include "common/dds/topic_discovery.hpp"
#include "common/dds/wait_set.hpp"
#include "services/inspector/bus_options.hpp"
#include "services/inspector/topic_meter.hpp"

namespace slammot::inspector {

/// A topic that is measured.
struct WatchedTopic {
  std::unique_ptr<dds::RawReader> reader;
  TopicMeter meter;
};

/// All topics of a bus, known to this program or not, as an observer sees them.
class BusView {
 public:
  using Handle = std::function<void(const dds::RawTopic&, const dds::RawSample&)>;

  /// Waits until everybody has been discovered, at most the options' patience.
  explicit BusView(const BusOptions& options);

  /// Receives for this time; begins to watch topics that appear meanwhile, if `watches_all`.
  void receive(std::chrono::milliseconds duration, bool watches_all);

  /// Begins to watch a topic that has a writer; false if its type cannot be learnt.
  bool watch(const std::string& topic);
  /// Called with each sample of a watched topic, in addition to the meter.
  void on_sample(Handle handle) { on_sample_ = std::move(handle); }

  const dds::Discovery& discovery() const { return discovery_; }
  const dds::Participant& participant() const { return participant_; }
  std::map<std::string, WatchedTopic>& topics() { return topics_; }
  /// Names of all topics that have an endpoint.
  std::set<std::string> topic_names() const;

 private:
  void update();
  void watch_new_topics();
  void take(WatchedTopic& watched);

  dds::Participant participant_;
  dds::Discovery discovery_;
  dds::TopicDiscovery writers_;
  std::map<std::string, dds::FoundWriter> writer_by_topic_;  ///< One that describes its type.
  std::map<std::string, WatchedTopic> topics_;
  std::set<std::string> unreadable_;
  Handle on_sample_;
  dds::WaitSet wait_set_;  // after topics_: it refers to their readers
};

}  // namespace slammot::inspector
