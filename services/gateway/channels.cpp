#include "services/gateway/channels.hpp"

#include <google/protobuf/descriptor.pb.h>

#include "common/files/base64.hpp"
#include "foxglove.pb.h"

namespace slammot::gateway {
namespace {

using google::protobuf::FileDescriptor;

/// Imported files come first, as readers of a FileDescriptorSet expect.
void append_with_imports(const FileDescriptor& file, google::protobuf::FileDescriptorSet& set) {
  for (const auto& known : set.file()) {
    if (known.name() == file.name()) return;
  }
  for (int i = 0; i < file.dependency_count(); ++i) append_with_imports(*file.dependency(i), set);
  file.CopyTo(set.add_file());
}

std::string schema_of_all_messages() {
  google::protobuf::FileDescriptorSet set;
  append_with_imports(*foxglove::LaserScan::descriptor()->file(), set);
  return files::to_base64(set.SerializeAsString());
}

template <typename Message>
Channel protobuf_channel(ChannelId id, const std::string& topic,
                         Retention retention = Retention::kNone) {
  static const std::string schema = schema_of_all_messages();
  return {id, topic, "protobuf", Message::descriptor()->full_name(), schema, retention};
}

Channel json_channel(ChannelId id, const std::string& topic,
                     Retention retention = Retention::kNone) {
  return {id,
          topic,
          "json",
          "slammot." + topic.substr(topic.rfind('/') + 1),
          R"({"type":"object"})",
          retention};
}

}  // namespace

const std::vector<Channel>& channels() {
  static const std::vector<Channel> all = {
      protobuf_channel<foxglove::LaserScan>(ChannelId::kScan, "/scan"),
      protobuf_channel<foxglove::PointCloud>(ChannelId::kPoints, "/scan/points"),
      protobuf_channel<foxglove::SceneUpdate>(ChannelId::kTracks, "/tracks"),
      protobuf_channel<foxglove::PoseInFrame>(ChannelId::kPose, "/pose"),
      protobuf_channel<foxglove::PosesInFrame>(ChannelId::kTrajectory, "/trajectory",
                                               Retention::kLast),
      protobuf_channel<foxglove::FrameTransforms>(ChannelId::kTransforms, "/tf"),
      protobuf_channel<foxglove::Grid>(ChannelId::kStationaryMap, "/map/stationary",
                                       Retention::kLastWanted),
      protobuf_channel<foxglove::Grid>(ChannelId::kMovingMap, "/map/moving",
                                       Retention::kLastWanted),
      protobuf_channel<foxglove::SceneUpdate>(ChannelId::kWays, "/map/ways", Retention::kLast),
      protobuf_channel<foxglove::LocationFix>(ChannelId::kFix, "/gnss"),
      protobuf_channel<foxglove::Log>(ChannelId::kLog, "/log", Retention::kLast),
      json_channel(ChannelId::kTrackDetails, "/slammot/tracks"),
      json_channel(ChannelId::kPoseDetails, "/slammot/pose"),
      json_channel(ChannelId::kGraph, "/slammot/graph", Retention::kLast),
      json_channel(ChannelId::kWayDetails, "/slammot/ways", Retention::kLast),
      json_channel(ChannelId::kHealth, "/slammot/health", Retention::kLast),
  };
  return all;
}

}  // namespace slammot::gateway
