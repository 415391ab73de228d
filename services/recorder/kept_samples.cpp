#include "services/recorder/kept_samples.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

namespace slammot::recorder {
namespace {

KeptSample kept(const mcap::Message& message) {
  return {message.head.log_time_ns,
          message.head.publish_time_ns,
          {message.data.begin(), message.data.end()}};
}

}  // namespace

std::map<InstanceKey, KeptSample> last_samples(const mcap::File& file, mcap::Selection selection,
                                               const KeyOf& key_of) {
  std::map<InstanceKey, KeptSample> last;
  mcap::MessageCursor cursor(file, std::move(selection));
  std::vector<std::uint8_t> key;
  while (const auto message = cursor.next()) {
    const mcap::ChannelId channel = message->head.channel_id;
    if (key_of(channel, message->data, key)) last[{channel, key}] = kept(*message);
  }
  return last;
}

KeptSamples::KeptSamples(const mcap::File& file, std::set<std::string> topics, KeyOf key_of,
                         std::size_t most_bytes)
    : file_(file),
      topics_(std::move(topics)),
      key_of_(std::move(key_of)),
      most_bytes_(most_bytes),
      reader_([this](const std::stop_token& stop) { read(stop); }) {}

void KeptSamples::read(const std::stop_token& stop) {
  std::int64_t complete_before_ns = std::numeric_limits<std::int64_t>::max();
  std::size_t bytes = 0;
  std::vector<std::uint8_t> key;
  // Without topics a cursor selects all.
  std::optional<mcap::MessageCursor> cursor;
  if (!topics_.empty()) cursor.emplace(file_, mcap::Selection{.topics = topics_});
  while (const auto message = cursor ? cursor->next() : std::nullopt) {
    if (stop.stop_requested()) return;
    bytes += message->data.size();
    if (bytes > most_bytes_) {
      complete_before_ns = message->head.log_time_ns;
      break;
    }
    if (!key_of_(message->head.channel_id, message->data, key)) continue;
    const std::lock_guard lock(mutex_);
    samples_[{message->head.channel_id, key}].push_back(kept(*message));
    complete_before_ns_ = message->head.log_time_ns;
    progress_.notify_all();
  }
  const std::lock_guard lock(mutex_);
  complete_before_ns_ = complete_before_ns;
  has_ended_ = true;
  progress_.notify_all();
}

void KeptSamples::visit(std::int64_t log_time_ns, const Visitor& visitor) {
  std::unique_lock lock(mutex_);
  progress_.wait(lock, [&] { return has_ended_ || complete_before_ns_ > log_time_ns; });
  std::map<InstanceKey, KeptSample> later;
  if (complete_before_ns_ <= log_time_ns)
    later = last_samples(file_, {topics_, complete_before_ns_, log_time_ns}, key_of_);
  for (const auto& [key, samples] : samples_) {
    const auto next = std::ranges::upper_bound(samples, log_time_ns, {}, &KeptSample::log_time_ns);
    if (next != samples.begin() && !later.contains(key)) visitor(key.first, *std::prev(next));
  }
  for (const auto& [key, sample] : later) visitor(key.first, sample);
}

}  // namespace slammot::recorder
