#include "services/slammot/replay_recording.hpp"

#include <algorithm>
#include <fstream>

#include "common/dds/cdr_walk.hpp"
#include "common/mcap/message_cursor.hpp"
#include "common/recordings/recorded_topic.hpp"

namespace slammot {
namespace {

template <typename Handle>
void for_each_sample(const mcap::File& file, const std::string& topic, const Handle& handle) {
  for (const auto& [id, channel] : file.contents().channels) {
    if (channel.topic != topic) continue;
    const auto playable = recordings::playable(file.contents(), channel);
    if (!playable) continue;
    mcap::MessageCursor cursor(file, {{topic}});
    while (const auto message = cursor.next())
      if (message->head.channel_id == id) handle(playable->topic->model(), message->data);
  }
}

}  // namespace

std::set<std::string> vehicles_in(const mcap::File& file, const ReplayPlan& plan) {
  std::set<std::string> vehicles;
  for_each_sample(file, plan.trigger, [&](const dds::TypeModel& model, mcap::Bytes cdr) {
    vehicles.insert(recordings::vehicle_of(model, cdr));
  });
  return vehicles;
}

std::vector<std::string> drive_ids(const mcap::File& file, const std::string& vehicle_id) {
  std::vector<std::string> ids;
  for_each_sample(
      file, "slammot/localized_scan", [&](const dds::TypeModel& model, mcap::Bytes cdr) {
        if (recordings::vehicle_of(model, cdr) != vehicle_id) return;
        dds::for_each_value(model, cdr, [&](const dds::CdrValue& value) {
          if (value.path != "odom_id") return;
          const std::string id = std::to_string(static_cast<std::uint64_t>(value.integer));
          if (std::ranges::find(ids, id) == ids.end()) ids.push_back(id);
        });
      });
  return ids;
}

std::vector<std::filesystem::path> extract_settings(const mcap::File& file,
                                                    const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const mcap::AttachmentIndex& index : file.contents().attachments) {
    const auto attachment = file.attachment(index);
    if (!attachment || attachment->media_type != "text/plain") continue;
    paths.push_back(folder / ("recorded-" + std::to_string(paths.size()) + ".textproto"));
    std::ofstream(paths.back(), std::ios::binary)
        .write(reinterpret_cast<const char*>(attachment->data.data()),
               static_cast<std::streamsize>(attachment->data.size()));
  }
  return paths;
}

}  // namespace slammot
