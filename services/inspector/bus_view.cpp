#include "services/inspector/bus_view.hpp"

#include <algorithm>
#include <thread>

namespace slammot::inspector {
namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 300ms;  ///< Without news everybody has been discovered.
constexpr auto kTypePatience = 500ms;

}  // namespace

BusView::BusView(const BusOptions& options)
    : participant_({options.domain_id, "slammot-inspector", options.dds_config}),
      discovery_(participant_) {
  discovery_.settle(kQuiet, options.patience);
  // An empty bus is quiet from the beginning: give it the whole patience.
  if (discovery_.endpoints().empty()) discovery_.settle(options.patience, options.patience);
}

std::set<std::string> BusView::topic_names() const {
  std::set<std::string> names;
  for (const auto& [guid, endpoint] : discovery_.endpoints()) names.insert(endpoint.topic);
  return names;
}

bool BusView::watch(const std::string& topic) {
  if (topics_.contains(topic)) return true;
  // A writer's QoS decides what a reader may ask for.
  for (const bool wants_writer : {true, false}) {
    for (const auto& [guid, endpoint] : discovery_.endpoints()) {
      if (endpoint.topic != topic || endpoint.is_writer != wants_writer) continue;
      auto reader = dds::AnyReader::open(participant_, endpoint, kTypePatience);
      if (!reader) continue;
      topics_.emplace(topic, WatchedTopic{std::move(*reader), {}});
      return true;
    }
  }
  return false;
}

void BusView::watch_new_topics() {
  for (const auto& [guid, endpoint] : discovery_.endpoints()) {
    if (!endpoint.is_writer || topics_.contains(endpoint.topic) ||
        unreadable_.contains(endpoint.topic))
      continue;
    if (!watch(endpoint.topic)) unreadable_.insert(endpoint.topic);
  }
}

void BusView::take_all() {
  for (auto& [name, watched] : topics_) {
    watched.reader.take_each([&, &meter = watched.meter](const dds::AnySample& sample) {
      if (sample.has_value)
        meter.add(sample.source_time_ns, sample.reception_time_ns, sample.bytes);
      if (on_sample_) on_sample_(name, sample);
    });
  }
}

void BusView::receive(std::chrono::milliseconds duration, bool watches_all) {
  const auto end = std::chrono::steady_clock::now() + duration;
  for (auto now = end - duration; now < end; now = std::chrono::steady_clock::now()) {
    discovery_.update();
    if (watches_all) watch_new_topics();
    std::vector<const dds::AnyReader*> readers;
    for (const auto& [name, watched] : topics_) readers.push_back(&watched.reader);
    dds::wait_for_any(participant_, readers,
                      std::min<std::chrono::nanoseconds>(
                          50ms, std::max<std::chrono::nanoseconds>(end - now, 0ns)));
    take_all();
  }
}

}  // namespace slammot::inspector
