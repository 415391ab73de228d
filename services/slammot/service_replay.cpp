#include "services/slammot/service_replay.hpp"

#include <algorithm>
#include <thread>

#include "common/dds/cdr_walk.hpp"
#include "common/recordings/recorded_topic.hpp"

namespace slammot {
namespace {

using namespace std::chrono_literals;

/// Keys and stamp are among the first bytes of a sample; the rest need not be read for them.
constexpr std::size_t kHeadBytes = 256;
/// loop_closing publishes what it found late after three status reports, 1 s each.
constexpr auto kPatienceForReply = 6s;
constexpr auto kPatienceAfterSilence = 300ms;
constexpr int kMostSilences = 20;
/// All endpoints of the service are announced together, those of this process before it started.
constexpr auto kAnnouncement = 500ms;
constexpr auto kLastOutputs = 300ms;
/// A service takes commands before the samples that wait for it.
constexpr auto kBeforeCommand = 300ms;
constexpr std::int64_t kLongestGapNs = 1'000'000'000;

std::optional<std::int64_t> stamp_of(const dds::TypeModel& model,
                                     std::span<const std::uint8_t> cdr) {
  std::optional<std::int64_t> stamp_ns;
  dds::for_each_value(model, cdr.first(std::min(cdr.size(), kHeadBytes)),
                      [&](const dds::CdrValue& value) {
                        if (value.path == "stamp_ns") stamp_ns = value.integer;
                      });
  return stamp_ns;
}

std::string identity_of(const dds::TypeModel& model, std::span<const std::uint8_t> cdr) {
  std::vector<std::uint8_t> key;
  dds::copy_key(model, cdr, key);
  std::string identity(key.begin(), key.end());
  if (const auto stamp_ns = stamp_of(model, cdr))
    identity.append("@").append(std::to_string(*stamp_ns));
  return identity;
}

}  // namespace

ServiceReplay::ServiceReplay(const dds::Participant& participant, const ReplaySource& source,
                             ReplayComparison& comparison)
    : source_(source), comparison_(comparison), wait_set_(participant) {
  for (const auto& [id, channel] : source.file.contents().channels) {
    const bool is_output = source.plan.is_output(channel.topic);
    if (!is_output && !source.plan.is_input(channel.topic)) continue;
    const auto playable = recordings::playable(source.file.contents(), channel);
    if (!playable) continue;
    const auto& [topic, qos] = *playable;
    if (is_output) {
      Output& output = outputs_of_[id];
      output.topic = channel.topic;
      output.raw = topic;
      output.reader = std::make_unique<dds::RawReader>(participant, topic, qos);
      wait_set_.on_data(*output.reader, [this, &output] { take(output); });
    } else {
      inputs_of_[id] = {topic, std::make_unique<dds::RawWriter>(participant, topic, qos)};
    }
  }
}

bool ServiceReplay::wait_for_service(std::chrono::seconds timeout) {
  const auto is_read = [](const auto& input) { return input.second.second->matched_readers() > 0; };
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (std::ranges::none_of(inputs_of_, is_read)) {
    if (std::chrono::steady_clock::now() > end) return false;
    wait_set_.wait(20ms);
  }
  std::this_thread::sleep_for(kAnnouncement);
  return true;
}

ServiceReplay::End ServiceReplay::run(app::Pace pace, const std::function<bool()>& is_stopped) {
  mcap::Selection selection;
  for (const auto& [id, input] : inputs_of_)
    selection.topics.insert(source_.file.contents().channels.at(id).topic);
  for (const auto& [id, output] : outputs_of_) selection.topics.insert(output.topic);
  ReplayOrder order(source_.file, selection);
  while (const auto message = order.next()) {
    if (is_stopped()) return End::kStopped;
    if (silences_ >= kMostSilences) return End::kSilent;
    await_turn(message->head.publish_time_ns, pace);
    const auto output = outputs_of_.find(message->head.channel_id);
    if (output == outputs_of_.end()) feed(*message);
    else compare(*message, output->second);
  }
  wait_set_.wait(kLastOutputs);
  note_left_over();
  return End::kDone;
}

/// While the service has something to answer time passes as it was recorded, so that it receives
/// what came meanwhile neither earlier nor later.
void ServiceReplay::await_turn(std::int64_t time_ns, app::Pace& pace) {
  auto now = std::chrono::steady_clock::now();
  auto due = now;
  if (!pace.is_unlimited()) {
    due = pace.due(time_ns, now);
  } else if (unanswered_ns_) {
    due += std::chrono::nanoseconds(
        std::clamp<std::int64_t>(time_ns - *unanswered_ns_, 0, kLongestGapNs));
    unanswered_ns_ = time_ns;
  }
  for (; now < due; now = std::chrono::steady_clock::now())
    wait_set_.wait(std::min<std::chrono::nanoseconds>(due - now, 50ms));
}

bool ServiceReplay::is_of_vehicle(const mcap::Message& message, const dds::TypeModel& model) const {
  return recordings::vehicle_of(model, message.data) == source_.vehicle_id;
}

void ServiceReplay::feed(const mcap::Message& message) {
  const auto& [topic, writer] = inputs_of_.at(message.head.channel_id);
  if (!is_of_vehicle(message, topic->model())) return;
  if (message.channel->topic == dds::topics::kCommand.name)
    std::this_thread::sleep_for(kBeforeCommand);
  writer->write({message.data, message.head.publish_time_ns});
  ++inputs_;
  if (message.channel->topic != source_.plan.trigger) return;
  unanswered_ns_ = message.head.publish_time_ns;
  has_begun_ = true;
}

void ServiceReplay::take(Output& output) {
  output.reader->take_each([&](const dds::RawSample& sample) {
    output.published[identity_of(output.raw->model(), sample.cdr)].emplace_back(sample.cdr.begin(),
                                                                                sample.cdr.end());
  });
}

bool ServiceReplay::await(Output& output, const Identity& identity) {
  const auto end =
      std::chrono::steady_clock::now() +
      (silences_ == 0 ? std::chrono::nanoseconds(kPatienceForReply) : kPatienceAfterSilence);
  while (output.published[identity].empty()) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= end) return false;
    wait_set_.wait(end - now);
  }
  return true;
}

/// Scans that the service published before the first one that the recording has for it are left
/// out.
void ServiceReplay::compare(const mcap::Message& message, Output& output) {
  const dds::TypeModel& model = output.raw->model();
  if (!is_of_vehicle(message, model)) return;
  if (output.topic == source_.plan.outputs.front()) unanswered_ns_.reset();
  if (!has_begun_ && stamp_of(model, message.data)) return;
  const auto stamp_ns = stamp_of(model, message.data);
  if (!output.first_ns) output.first_ns = stamp_ns;
  output.last_ns = stamp_ns;
  const ReplayedSample recorded{&output.topic, &model, stamp_ns, seconds_of(message), message.data};
  const Identity identity = identity_of(model, message.data);
  if (!await(output, identity)) {
    ++silences_;
    return comparison_.note_missing(recorded);
  }
  silences_ = 0;
  comparison_.compare(recorded, output.published[identity].front());
  output.published[identity].pop_front();
}

/// Only scans between the first and the last one in the recording are judged.
void ServiceReplay::note_left_over() {
  for (const auto& [id, output] : outputs_of_) {
    const dds::TypeModel& model = output.raw->model();
    for (const auto& [identity, samples] : output.published) {
      for (const auto& cdr : samples) {
        const auto stamp_ns = stamp_of(model, cdr);
        const bool is_judged =
            !stamp_ns || (stamp_ns >= output.first_ns && stamp_ns <= output.last_ns);
        if (is_judged) comparison_.note_additional({&output.topic, &model, stamp_ns, 0.0, cdr});
      }
    }
  }
}

double ServiceReplay::seconds_of(const mcap::Message& message) const {
  return static_cast<double>(message.head.log_time_ns -
                             source_.file.contents().statistics.start_ns) *
         1e-9;
}

}  // namespace slammot
