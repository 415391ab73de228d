#include "services/recorder/player.hpp"

#include <thread>

#include "services/recorder/recorded_topic.hpp"

namespace slammot::recorder {
namespace {

/// Longest sleep, so that a signal ends the player soon.
constexpr std::chrono::milliseconds kNap{50};

void sleep_until(app::Pace::Time due, const std::atomic<bool>& is_stopped) {
  for (auto now = app::Pace::Time::clock::now(); now < due && !is_stopped;
       now = app::Pace::Time::clock::now())
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(due - now, kNap));
}

}  // namespace

Player::Player(const dds::Participant& participant, const mcap::File& file,
               const TopicSelection& selection)
    : file_(file) {
  for (const auto& [id, channel] : file.contents().channels) {
    if (!selection.contains(channel.topic)) continue;
    const auto schema = file.contents().schemas.find(channel.schema_id);
    const bool has_schema = schema != file.contents().schemas.end();
    auto topic = playable(channel, has_schema ? &schema->second : nullptr);
    if (!topic) {
      unplayable_.push_back(channel.topic);
      continue;
    }
    writers_[id] = std::make_unique<dds::RawWriter>(participant, topic->topic, topic->qos);
  }
}

void Player::play(std::int64_t from_ns, std::int64_t to_ns, app::Pace pace,
                  const std::atomic<bool>& is_stopped) {
  mcap::Selection selection{{}, from_ns, to_ns};
  for (const auto& [id, writer] : writers_)
    selection.topics.insert(file_.contents().channels.at(id).topic);
  if (selection.topics.empty()) return;
  mcap::MessageCursor cursor(file_, selection);
  while (const auto message = cursor.next()) {
    if (!pace.is_unlimited())
      sleep_until(pace.due(message->head.log_time_ns, app::Pace::Time::clock::now()), is_stopped);
    if (is_stopped) return;
    write(*message);
  }
}

void Player::write(const mcap::Message& message) {
  const auto writer = writers_.find(message.head.channel_id);
  if (writer == writers_.end()) return;
  switch (writer->second->write({message.data, message.head.publish_time_ns})) {
    case dds::RawWriteResult::kWritten: ++counters_.played; break;
    case dds::RawWriteResult::kTimedOut: ++counters_.timed_out; break;
    case dds::RawWriteResult::kMalformed: ++counters_.malformed; break;
  }
}

bool Player::wait_for_acknowledgements(std::chrono::nanoseconds timeout) const {
  const auto end = std::chrono::steady_clock::now() + timeout;
  bool is_complete = true;
  for (const auto& [id, writer] : writers_) {
    const auto left = std::max<std::chrono::nanoseconds>(end - std::chrono::steady_clock::now(),
                                                         std::chrono::nanoseconds(0));
    is_complete = writer->wait_for_acknowledgements(left) && is_complete;
  }
  return is_complete;
}

}  // namespace slammot::recorder
