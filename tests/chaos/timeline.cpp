// Writes what localization, detection and tracking publish, one line of CSV a sample, as a reader
// of the bus accepts it: KIND,received_ns,stamp_ns,... by the system clock.
//   pose,received_ns,stamp_ns,x_m,y_m,heading_rad,map_id         in odom
//   segments,received_ns,stamp_ns
//   tracks,received_ns,stamp_ns,ID:x_m:y_m,...                   confirmed ones, in map
//   beat,received_ns,0,SERVICE,process,stands_by,term
// tests/chaos/timeline.py reads them.
#include <cstdio>
#include <cstdlib>

#include "common/app/service_context.hpp"
#include "common/app/stop_signal.hpp"
#include "common/app/system_clock.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/tracked_objects.hpp"

namespace {

using namespace slammot;
using app::Input;

void begin_line(const char* kind, std::int64_t stamp_ns) {
  std::printf("%s,%lld,%lld", kind, static_cast<long long>(app::system_clock_ns()),
              static_cast<long long>(stamp_ns));
}

void end_line() {
  std::putchar('\n');
  std::fflush(stdout);
}

void write(const slammot_LocalizedScan& sample) {
  const auto scan = wire::decode(sample);
  if (!scan) return;
  const geometry::Pose2& pose = scan->odom_from_base.pose;
  begin_line("pose", scan->stamp_ns);
  std::printf(",%.6f,%.6f,%.8f,%llu", pose.x_m, pose.y_m, pose.heading_rad,
              static_cast<unsigned long long>(scan->map_id.value));
  end_line();
}

void write(const slammot_TrackedObjects& sample) {
  const auto objects = wire::decode(sample);
  if (!objects) return;
  begin_line("tracks", objects->stamp_ns);
  for (const flow::TrackedObject& object : objects->objects) {
    if (!object.confirmed) continue;
    const geometry::Vector2 position_m = objects->map_from_odom * object.position_in_odom_m;
    std::printf(",%u:%.3f:%.3f", object.track_id.value, position_m.x(), position_m.y());
  }
  end_line();
}

void write(const slammot_SegmentedScan& sample) {
  begin_line("segments", sample.stamp_ns);
  end_line();
}

void write(const slammot_Heartbeat& sample) {
  const auto beat = wire::decode(sample);
  if (!beat) return;
  begin_line("beat", 0);
  std::printf(",%s,%u,%d,%u", beat->name.service.c_str(), beat->process_number, beat->stands_by,
              beat->term);
  end_line();
}

}  // namespace

int main(int argc, char** argv) {
  app::ServiceOptions options;
  options.domain_id = static_cast<std::uint32_t>(std::atoi(argc > 1 ? argv[1] : "0"));
  if (argc > 2) options.vehicle_id = argv[2];
  options.instance = "timeline";
  app::ServiceContext context("timeline", options);
  const app::StopSignal stop_signal([&] { context.stop(); });
  const auto line = [](const auto& sample) { write(sample); };
  const auto all = dds::History::kRecorder;
  context.read(dds::topics::kLocalizedScan, Input::kOccasional, line, all);
  context.read(dds::topics::kSegmentedScan, Input::kOccasional, line, all);
  context.read(dds::topics::kTrackedObjects, Input::kOccasional, line, all);
  context.read(dds::topics::kHeartbeat, Input::kOccasional, line, all);
  context.run();
}
