#include "services/gateway/recording_conversion.hpp"

#include <unistd.h>

#include <functional>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>

#include "common/dds/config.hpp"
#include "common/dds/raw_writer.hpp"
#include "common/dds/reader.hpp"
#include "common/mcap/message_cursor.hpp"
#include "common/recordings/recorded_topic.hpp"
#include "common/wire/sensor.hpp"
#include "services/gateway/drive_messages.hpp"

namespace slammot::gateway {
namespace {

namespace topics = dds::topics;

constexpr std::int64_t kMapPeriodNs = 250'000'000;

DriveMessages::Time time_at(std::int64_t log_time_ns) {
  return DriveMessages::Time(std::chrono::nanoseconds(log_time_ns));
}

/// Reads recorded bytes as samples of the types that are compiled in: the library converts between
/// a writer of bytes and a typed reader of the same process, on a bus of its own.
class Decoder {
 public:
  Decoder(const mcap::File& recording, MessageFormat& format, DriveMessages& drive,
          ConvertedRecording& result)
      : participant_({0, "slammot-convert",
                      dds::loopback_config("slammot-convert-" + std::to_string(getpid()))}),
        format_(format),
        drive_(drive),
        result_(result) {
    add(recording, topics::kLaserScan);
    add(recording, topics::kLocalizedScan);
    add(recording, topics::kScanLabels);
    add(recording, topics::kTrackedObjects);
    add(recording, topics::kGnssFix);
    add(recording, topics::kStoredSubmapTile);
    add(recording, topics::kGraphCorrection);
    add(recording, topics::kConstraint);
    add(recording, topics::kTrafficWays);
  }

  bool is_empty() const { return takes_.empty(); }

  void take(const mcap::Message& message) {
    if (const auto take = takes_.find(message.head.channel_id); take != takes_.end())
      take->second(message);
  }

 private:
  template <typename Sample>
  void add(const mcap::File& recording, const dds::Topic<Sample>& topic) {
    for (const auto& [id, channel] : recording.contents().channels) {
      if (channel.topic != topic.name) continue;
      const auto playable = recordings::playable(recording.contents(), channel);
      if (!playable) continue;
      const auto writer =
          std::make_shared<dds::RawWriter>(participant_, playable->topic, playable->qos);
      const auto reader = std::make_shared<dds::Reader<Sample>>(participant_, topic);
      takes_[id] = [this, writer, reader,
                    cut = std::uint64_t{0}](const mcap::Message& message) mutable {
        if (writer->write({message.data, message.head.publish_time_ns}) !=
            dds::RawWriteResult::kWritten)
          ++result_.dropped;
        reader->take_each([this](const Sample& sample) { take(sample); });
        result_.dropped += reader->cut() - std::exchange(cut, reader->cut());
      };
    }
  }

  template <typename Sample>
  void take(const Sample& sample) {
    if (result_.vehicle_id.empty()) result_.vehicle_id = sample.vehicle_id;
    if (result_.vehicle_id != sample.vehicle_id) return;
    if constexpr (std::is_same_v<Sample, slammot_LaserScan>) know_scanner(sample);
    drive_.take(sample);
  }

  void know_scanner(const slammot_LaserScan& sample) {
    if (const auto scan = wire::decode(sample)) format_.know(scan->scanner);
  }

  dds::Participant participant_;
  MessageFormat& format_;
  DriveMessages& drive_;
  ConvertedRecording& result_;
  std::map<mcap::ChannelId, std::function<void(const mcap::Message&)>> takes_;
};

}  // namespace

ConvertedRecording convert_recording(const mcap::File& recording,
                                     const std::filesystem::path& output, MessageFormat& format,
                                     const std::string& vehicle_id) {
  ConvertedRecording result;
  result.vehicle_id = vehicle_id;
  ViewerFile file(output, format);
  if (!file.fault().empty()) return {0, 0, {}, file.fault()};
  DriveMessages drive(file, [&](const char*, std::string_view) { ++result.dropped; });
  Decoder decoder(recording, format, drive, result);
  if (decoder.is_empty()) {
    std::filesystem::remove(output);
    return {0, 0, {}, "the recording has no topic that viewers know"};
  }
  mcap::MessageCursor cursor(recording, {});
  std::int64_t map_due_ns = recording.contents().statistics.start_ns;
  while (const auto message = cursor.next()) {
    const std::int64_t now_ns = message->head.log_time_ns;
    file.set_time(now_ns);
    decoder.take(*message);
    if (now_ns < map_due_ns) continue;
    map_due_ns = now_ns + kMapPeriodNs;
    drive.finish_map();
    drive.publish_map(time_at(now_ns));
  }
  for (const std::int64_t last_ns : {map_due_ns, map_due_ns + kMapPeriodNs}) {  // grids come second
    drive.finish_map();
    drive.publish_map(time_at(last_ns));
  }
  if (!file.finish()) result.fault = file.fault();
  result.messages = file.messages();
  return result;
}

}  // namespace slammot::gateway
