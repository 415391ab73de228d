/// For tests with tools that know nothing of this project: a participant that writes samples to
/// every topic there is.
///     publish_every_topic DOMAIN TAG
/// Prints the DDS configuration that a tool needs to see it, then "topic TOPIC TYPE" for each, then
/// "ready"; goes on writing until its standard input ends.

#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "common/dds/config.hpp"
#include "common/dds/wait_set.hpp"
#include "common/dds/writer.hpp"
#include "common/wire/collision_warnings.hpp"
#include "common/wire/graph.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/segmented_scan.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/service.hpp"
#include "common/wire/stored_map.hpp"
#include "common/wire/submap.hpp"
#include "common/wire/tracked_objects.hpp"
#include "common/wire/traffic_ways.hpp"
#include "common/wire/truth.hpp"
#include "tests/support/values.hpp"

namespace {

using namespace slammot;
namespace topics = dds::topics;

constexpr const char* kVehicle = "test-car";

class EveryTopic {
 public:
  explicit EveryTopic(const dds::Participant& participant) : participant_(participant) {
    add_sensors();
    add_truth();
    add_estimates();
    add_maps();
    add_services();
  }

  void write_all() const {
    for (const auto& [name, write] : write_) write();
  }

  bool has(std::string_view topic) const { return write_.contains(std::string(topic)); }

 private:
  template <typename Sample, typename Write>
  void add(const dds::Topic<Sample>& topic, Write write) {
    auto writer = std::make_shared<dds::Writer<Sample>>(participant_, topic);
    write_[std::string(topic.name)] = [writer, write] { write(*writer); };
  }

  /// For what an encoder with buffers makes of a value.
  template <typename Encoder, typename Sample, typename Value>
  void add_encoded(const dds::Topic<Sample>& topic, const Value& value) {
    auto encoder = std::make_shared<Encoder>();
    add(topic, [encoder, value](auto& writer) { writer.write(encoder->encode(kVehicle, value)); });
  }

  void add_sensors() {
    add_encoded<wire::LaserScanEncoder>(topics::kLaserScan, testing::laser_scan(random_, 5));
    add(topics::kOdometry, [](auto& writer) {
      writer.write(wire::encode(kVehicle, sensing::Odometry{1, {1.0, 2.0, 3.0}}));
    });
    add(topics::kGnssFix, [](auto& writer) {
      writer.write(wire::encode(kVehicle, sensing::GnssFix{.stamp_ns = 1}));
    });
    add(topics::kCompassReading, [](auto& writer) {
      writer.write(wire::encode(kVehicle, sensing::CompassReading{.stamp_ns = 1}));
    });
  }

  void add_truth() {
    simulation::SimulatedScan scan;
    scan.scan = testing::laser_scan(random_, 3);
    scan.objects.resize(1);
    scan.hits = {0, 1, -1};
    const auto encoder = std::make_shared<wire::TruthEncoder>();
    add(topics::kTruePose,
        [encoder, scan](auto& writer) { writer.write(encoder->encode_pose(kVehicle, scan)); });
    add(topics::kTrueObjects,
        [encoder, scan](auto& writer) { writer.write(encoder->encode_objects(kVehicle, scan)); });
    add(topics::kTrueHits,
        [encoder, scan](auto& writer) { writer.write(encoder->encode_hits(kVehicle, scan)); });
  }

  void add_estimates() {
    add_encoded<wire::LocalizedScanEncoder>(topics::kLocalizedScan,
                                            testing::localized_scan(random_, 5));
    add_encoded<wire::SegmentedScanEncoder>(topics::kSegmentedScan,
                                            testing::segmented_scan(random_, 5));
    add_encoded<wire::TrackedObjectsEncoder>(topics::kTrackedObjects,
                                             testing::tracked_objects(random_, 2));
    add_encoded<wire::TrackedObjectsEncoder>(topics::kStoredTrackedObjects,
                                             testing::tracked_objects(random_, 2));
    add_encoded<wire::ScanLabelsEncoder>(
        topics::kScanLabels,
        flow::ScanLabels{1, 2, "front", {flow::PointLabel::kMoving}, {{1, {2, 3}}}});
    add_encoded<wire::CollisionWarningsEncoder>(
        topics::kCollisionWarnings,
        flow::CollisionWarnings{
            .stamp_ns = 1, .objects = {{{7}, flow::WarningLevel::kCaution, 0.4, 2.5, 0.0, 2.4}}});
  }

  void add_maps() {
    const auto write_tiles = [submap = testing::submap(random_, 1, 3, 2, 4)](auto& writer) {
      wire::SubmapEncoder().encode(kVehicle, submap,
                                   [&](const slammot_SubmapTile& tile) { writer.write(tile); });
    };
    add(topics::kSubmapTile, write_tiles);
    add(topics::kStoredSubmapTile, write_tiles);
    add(topics::kStoredMap, [](auto& writer) {
      writer.write(wire::encode(kVehicle, flow::StoredMap{{7}, 3, 0, {2}, 0.2}));
    });
    add(topics::kConstraint, [pose = testing::uncertain_pose(random_)](auto& writer) {
      writer.write(
          wire::encode(kVehicle, flow::Constraint{{0}, {1}, flow::ConstraintKind::kLoop, pose}));
    });
    add(topics::kGraphCorrection, [](auto& writer) {
      const flow::GraphCorrection correction{1, {1.0, 2.0, 3.0}, {{{0}, {}}, {{1}, {}}}};
      wire::GraphCorrectionEncoder().encode(
          kVehicle, correction, [&](const slammot_GraphCorrection& part) { writer.write(part); });
    });
    add(topics::kTrafficWays, [](auto& writer) {
      const traffic::TrafficWays ways{1, 2, {7}, {testing::way(traffic::Mover::kBicycle, 5)}};
      wire::TrafficWaysEncoder().encode(
          kVehicle, ways, [&](const slammot_TrafficWays& part) { writer.write(part); });
    });
  }

  void add_services() {
    const wire::ServiceName name{kVehicle, "detection", "front"};
    add(topics::kHeartbeat,
        [name](auto& writer) { writer.write(wire::encode(wire::Heartbeat{.name = name})); });
    add(topics::kStatus, [name](auto& writer) {
      wire::StatusEncoder encoder;
      writer.write(encoder.encode(
          {.name = name, .counters = {{"scans", 7}}, .latencies = {{"detect", 7, 0.1, 0.2, 0.3}}}));
    });
    add(topics::kCommand, [](auto& writer) {
      writer.write(
          wire::encode(wire::Command{kVehicle, "localization", "test-1", 1, "finish_submap", ""}));
    });
    add(topics::kReply, [](auto& writer) {
      writer.write(wire::encode(
          wire::Reply{kVehicle, "test-1", 1, "localization", wire::Outcome::kDone, ""}));
    });
  }

  const dds::Participant& participant_;
  testing::Random random_{1};
  std::map<std::string, std::function<void()>> write_;
};

int publish(std::uint32_t domain_id, const std::string& tag) {
  const std::string config = dds::loopback_config(tag);
  const dds::Participant participant(
      {.domain_id = domain_id, .name = "publish-every-topic", .config = config});
  const EveryTopic every_topic(participant);
  std::cout << config << '\n';
  for (const dds::TopicInfo* topic : dds::topic_table()) {
    if (!every_topic.has(topic->name)) {
      std::cerr << "no writer for topic " << topic->name << '\n';
      return 1;
    }
    std::cout << "topic " << topic->name << ' ' << topic->type_name() << '\n';
  }
  std::cout << "ready" << std::endl;

  // Again and again: the volatile ones reach a tool only after it has come.
  dds::WaitSet wait_set(participant);
  std::thread stopper([&] {
    std::cin.ignore(std::numeric_limits<std::streamsize>::max());
    wait_set.stop();
  });
  do {
    every_topic.write_all();
  } while (wait_set.wait(std::chrono::milliseconds(200)) != dds::WaitSet::Wake::kStopped);
  stopper.join();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: publish_every_topic DOMAIN TAG\n";
    return 2;
  }
  return publish(static_cast<std::uint32_t>(std::stoul(argv[1])), argv[2]);
}
