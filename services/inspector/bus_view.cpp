#include "services/inspector/bus_view.hpp"

#include <algorithm>
#include <utility>

#include "common/app/system_clock.hpp"

namespace slammot::inspector {
namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 300ms;  ///< Without news everybody has been discovered.
constexpr auto kTypePatience = 500ms;

}  // namespace

BusView::BusView(const BusOptions& options)
    : participant_({options.domain_id, "slammot-inspector", options.dds_config}),
      discovery_(participant_),
      writers_(participant_),
      wait_set_(participant_) {
  discovery_.settle(kQuiet, options.patience);
  // An empty bus is quiet from the beginning: give it the whole patience.
  if (discovery_.endpoints().empty()) discovery_.settle(options.patience, options.patience);
  update();
}

void BusView::update() {
  discovery_.update();
  for (dds::FoundWriter& writer : writers_.take()) {
    if (!writer.information) continue;
    unreadable_.erase(writer.topic_name);
    const std::string topic = writer.topic_name;
    writer_by_topic_.insert_or_assign(topic, std::move(writer));
  }
}

std::set<std::string> BusView::topic_names() const {
  std::set<std::string> names;
  for (const auto& [guid, endpoint] : discovery_.endpoints()) names.insert(endpoint.topic);
  return names;
}

bool BusView::watch(const std::string& topic) {
  if (topics_.contains(topic)) return true;
  const auto writer = writer_by_topic_.find(topic);
  if (writer == writer_by_topic_.end()) return false;
  auto raw = dds::RawTopic::resolve(participant_, topic, writer->second.type_name,
                                    *writer->second.information, kTypePatience);
  if (!raw) return false;
  WatchedTopic& watched = topics_[topic];
  watched.reader =
      std::make_unique<dds::RawReader>(participant_, std::move(raw), writer->second.qos);
  wait_set_.on_data(*watched.reader, [this, &watched] { take(watched); });
  return true;
}

void BusView::watch_new_topics() {
  for (const auto& [topic, writer] : writer_by_topic_) {
    if (topics_.contains(topic) || unreadable_.contains(topic)) continue;
    if (!watch(topic)) unreadable_.insert(topic);
  }
}

void BusView::take(WatchedTopic& watched) {
  watched.reader->take_each([&](const dds::RawSample& sample) {
    watched.meter.add(sample.source_time_ns, app::system_clock_ns(), sample.cdr.size());
    if (on_sample_) on_sample_(watched.reader->raw_topic(), sample);
  });
}

void BusView::receive(std::chrono::milliseconds duration, bool watches_all) {
  const auto end = std::chrono::steady_clock::now() + duration;
  for (auto now = end - duration; now < end; now = std::chrono::steady_clock::now()) {
    update();
    if (watches_all) watch_new_topics();
    wait_set_.wait(std::min<std::chrono::nanoseconds>(50ms, end - now));
  }
}

}  // namespace slammot::inspector
