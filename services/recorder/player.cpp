#include "services/recorder/player.hpp"

#include <algorithm>
#include <utility>

#include "common/dds/cdr_walk.hpp"
#include "common/recordings/recorded_topic.hpp"

namespace slammot::recorder {
namespace {

/// Of a topic with more messages a second the kept ones are found within the time below.
constexpr double kRare_hz = 20.0;  // more than the tiles of a map, fewer than scans
constexpr std::int64_t kLookBackNs = 3'000'000'000;

}  // namespace

Player::Player(const dds::Participant& participant, const mcap::File& file,
               const TopicSelection& selection)
    : file_(file) {
  for (const auto& [id, channel] : file.contents().channels) {
    if (!selection.contains(channel.topic)) continue;
    auto topic = recordings::playable(file.contents(), channel);
    if (!topic) {
      unplayable_.push_back(channel.topic);
      continue;
    }
    writers_[id] = {topic->topic,
                    std::make_unique<dds::RawWriter>(participant, topic->topic, topic->qos),
                    kept_by(id, topic->qos)};
  }
}

std::set<std::string> Player::topics() const {
  std::set<std::string> topics;
  for (const auto& [id, output] : writers_) topics.insert(file_.contents().channels.at(id).topic);
  return topics;
}

bool Player::has_writer(std::uint64_t writer_handle) const {
  return std::ranges::any_of(writers_, [&](const auto& item) {
    return item.second.writer->instance_handle() == writer_handle;
  });
}

Player::Keeps Player::kept_by(mcap::ChannelId channel, const dds::OfferedQos& qos) const {
  const bool is_status = file_.contents().channels.at(channel).topic == dds::topics::kStatus.name;
  if (!qos.is_transient_local || is_status) return Keeps::kNothing;  // the next one comes at once
  const mcap::Statistics& statistics = file_.contents().statistics;
  const auto count = statistics.messages_of.find(channel);
  const double duration_s = static_cast<double>(statistics.end_ns - statistics.start_ns) * 1e-9;
  const bool is_frequent = count != statistics.messages_of.end() &&
                           static_cast<double>(count->second) > kRare_hz * duration_s;
  return is_frequent ? Keeps::kFrequentValues : Keeps::kRareValues;
}

std::set<std::string> Player::topics_that_keep(Keeps what) const {
  std::set<std::string> topics;
  for (const auto& [id, output] : writers_) {
    if (output.keeps == what) topics.insert(file_.contents().channels.at(id).topic);
  }
  return topics;
}

bool Player::play(const PlayRange& range, PlayControl& control) {
  if (writers_.empty()) return true;
  PlayRange rest = range;
  for (;;) {
    if (rest.from_ns > file_.contents().statistics.start_ns) restore(rest.from_ns - 1);
    const auto turn = play_from(rest, control);
    if (turn != PlayControl::Turn::kSeek) return turn == PlayControl::Turn::kPlay;
    rest.from_ns = control.take_seek();
  }
}

PlayControl::Turn Player::play_from(const PlayRange& range, PlayControl& control) {
  mcap::MessageCursor cursor(file_, {topics(), range.from_ns, range.to_ns});
  while (const auto message = cursor.next()) {
    const auto turn = control.await(message->head.log_time_ns);
    if (turn != PlayControl::Turn::kPlay) return turn;
    write(message->head.channel_id, {message->data, message->head.publish_time_ns});
  }
  return control.is_stopped() ? PlayControl::Turn::kStop : PlayControl::Turn::kPlay;
}

bool Player::has_message_in(const PlayRange& range) const {
  return mcap::MessageCursor(file_, {topics(), range.from_ns, range.to_ns}).next().has_value();
}

KeyOf Player::key_of() const {
  return [this](mcap::ChannelId channel, mcap::Bytes cdr, std::vector<std::uint8_t>& key) {
    return dds::copy_key(writers_.at(channel).topic->model(), cdr, key);
  };
}

void Player::prepare_seeks() {
  if (rare_values_) return;
  rare_values_ =
      std::make_unique<KeptSamples>(file_, topics_that_keep(Keeps::kRareValues), key_of());
}

void Player::restore(std::int64_t log_time_ns) {
  const auto write_it = [this](mcap::ChannelId channel, const KeptSample& sample) {
    write(channel, {sample.cdr, sample.source_ns});
  };
  prepare_seeks();
  rare_values_->visit(log_time_ns, write_it);
  const std::set<std::string> frequent = topics_that_keep(Keeps::kFrequentValues);
  if (frequent.empty()) return;
  for (const auto& [key, sample] :
       last_samples(file_, {frequent, log_time_ns - kLookBackNs, log_time_ns}, key_of()))
    write_it(key.first, sample);
}

void Player::write(mcap::ChannelId channel, const dds::RawSample& sample) {
  const auto output = writers_.find(channel);
  if (output == writers_.end()) return;
  switch (output->second.writer->write(sample)) {
    case dds::RawWriteResult::kWritten: ++counters_.played; break;
    case dds::RawWriteResult::kTimedOut: ++counters_.timed_out; break;
    case dds::RawWriteResult::kMalformed: ++counters_.malformed; break;
  }
}

bool Player::wait_for_acknowledgements(std::chrono::nanoseconds timeout) const {
  const auto end = std::chrono::steady_clock::now() + timeout;
  bool is_complete = true;
  for (const auto& [id, output] : writers_) {
    const auto left = std::max<std::chrono::nanoseconds>(end - std::chrono::steady_clock::now(),
                                                         std::chrono::nanoseconds(0));
    is_complete = output.writer->wait_for_acknowledgements(left) && is_complete;
  }
  return is_complete;
}

}  // namespace slammot::recorder
