// Watches the services of all vehicles in a domain, for the tests of this folder: one line of JSON
// a period with latencies from the publication of a scan, poses, track ids and statuses. With
// --send: sends one command to a service and prints its answer.
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/app/stop_signal.hpp"
#include "common/app/system_clock.hpp"
#include "common/dds/participant.hpp"
#include "common/dds/wait_set.hpp"
#include "common/dds/writer.hpp"
#include "common/wire/service.hpp"
#include "common/wire/text.hpp"

namespace {

using nlohmann::json;
using namespace slammot;
using namespace std::chrono_literals;

constexpr std::int64_t kGivenUpAfterNs = 2'000'000'000;
constexpr const char* kTracked = "tracked";

/// Of one vehicle, since the last line.
struct Vehicle {
  std::map<std::int64_t, std::int64_t> published_ns;  ///< By stamp; until there are tracks.
  /// Answers to scans that have not come to this process yet: stage and time, by stamp.
  std::map<std::int64_t, std::map<std::string, std::int64_t>> early_ns;
  std::uint64_t scans = 0, tracked = 0;     ///< Since the start,
  std::vector<std::int64_t> unanswered_ns;  ///< as when scans without tracks came.
  std::map<std::string, std::vector<double>> latencies_ms;
  json pose;  ///< The last one: stamp [ns], x [m], y [m], heading [rad] in odom, map_id.
  json tracks = json::array();  ///< The last confirmed ones: id, x [m], y [m] in odom.
};

class Observer {
 public:
  Observer(std::uint32_t domain_id, bool with_stages)
      : participant_({domain_id, "chaos-observer", std::nullopt}),
        wait_set_(participant_),
        scans_(participant_, dds::topics::kLaserScan, dds::History::kRecorder),
        localized_(participant_, dds::topics::kLocalizedScan, dds::History::kRecorder),
        segmented_(participant_, dds::topics::kSegmentedScan, dds::History::kRecorder),
        tracked_(participant_, dds::topics::kTrackedObjects, dds::History::kRecorder),
        statuses_(participant_, dds::topics::kStatus) {
    wait_set_.on_data(scans_, [this] { take_scans(); });
    read(localized_, [this](const auto& sample, const auto&) { take(sample); });
    if (with_stages)
      read(segmented_, [this](const auto& sample, const auto&) { note("segmented", sample); });
    read(tracked_, [this](const auto& sample, const auto&) { take(sample); });
    read(statuses_, [this](const auto& sample, const auto&) { take(sample); });
  }

  /// False once stopped.
  bool wait(std::chrono::nanoseconds longest) {
    return wait_set_.wait(longest) != dds::WaitSet::Wake::kStopped;
  }
  void stop() { wait_set_.stop(); }

  /// What came since the last call.
  json line() {
    const std::int64_t now_ns = app::system_clock_ns();
    json vehicles = json::object();
    for (auto& [name, vehicle] : vehicles_) vehicles[name] = describe(vehicle, now_ns);
    json services = json::array();
    for (const auto& [key, status] : services_) services.push_back(status);
    return {{"time_s", static_cast<double>(now_ns) * 1e-9},
            {"vehicles", vehicles},
            {"services", services}};
  }

 private:
  template <typename Sample, typename Handle>
  void read(dds::Reader<Sample>& reader, Handle handle) {
    wait_set_.on_data(reader, [&reader, handle] { reader.take_each(handle); });
  }

  void take_scans() {
    scans_.take_each([this](const auto& sample, const auto& info) { take(sample, info); });
  }

  void take(const slammot_LaserScan& sample, const dds::SampleInfo& info) {
    Vehicle& vehicle = vehicles_[std::string(wire::text(sample.vehicle_id))];
    ++vehicle.scans;
    vehicle.published_ns.emplace(sample.stamp_ns, info.source_time_ns);
    const auto early = vehicle.early_ns.extract(sample.stamp_ns);
    if (early.empty()) return;
    for (const auto& [stage, came_ns] : early.mapped()) {
      vehicle.latencies_ms[stage].push_back(static_cast<double>(came_ns - info.source_time_ns) *
                                            1e-6);
      if (stage == kTracked) vehicle.tracked += vehicle.published_ns.erase(sample.stamp_ns);
    }
  }

  void take(const slammot_LocalizedScan& sample) {
    Vehicle& vehicle = note("localized", sample);
    const slammot_Pose2& pose = sample.odom_from_base.mean;
    vehicle.pose = {sample.stamp_ns, pose.x_m, pose.y_m, pose.heading_rad, sample.map_id};
  }

  void take(const slammot_TrackedObjects& sample) {
    Vehicle& vehicle = note(kTracked, sample);
    vehicle.tracked += vehicle.published_ns.erase(sample.stamp_ns);
    vehicle.tracks.clear();
    for (std::uint32_t i = 0; i < sample.objects._length; ++i) {
      const slammot_TrackedObject& object = sample.objects._buffer[i];
      if (object.confirmed)
        vehicle.tracks.push_back(
            {object.track_id, object.position_in_odom_m.x, object.position_in_odom_m.y});
    }
  }

  /// The first answer of a stage to each scan. The scan itself may come later, when a packet of it
  /// was lost on the way to this process.
  template <typename Sample>
  Vehicle& note(const char* stage, const Sample& sample) {
    Vehicle& vehicle = vehicles_[std::string(wire::text(sample.vehicle_id))];
    // This process may have been interrupted between the turn of the scans and that of the answers.
    if (!vehicle.published_ns.contains(sample.stamp_ns)) take_scans();
    const auto published = vehicle.published_ns.find(sample.stamp_ns);
    const std::int64_t now_ns = app::system_clock_ns();
    if (published != vehicle.published_ns.end())
      vehicle.latencies_ms[stage].push_back(static_cast<double>(now_ns - published->second) * 1e-6);
    else vehicle.early_ns[sample.stamp_ns].emplace(stage, now_ns);
    return vehicle;
  }

  void take(const slammot_ServiceStatus& sample) {
    const auto status = wire::decode(sample);
    if (!status) return;
    json counters = json::object(), latencies = json::object();
    for (const wire::Counter& one : status->counters) counters[one.name] = one.total;
    for (const wire::StageLatency& one : status->latencies)
      latencies[one.stage] = {{"calls", one.calls},
                              {"p50_ms", one.p50_ms},
                              {"p99_ms", one.p99_ms},
                              {"worst_ms", one.highest_ms}};
    services_[status->name.vehicle_id + "/" + status->name.service + "/" + status->name.instance +
              "/" + std::to_string(status->process_number)] = {
        {"vehicle", status->name.vehicle_id},
        {"service", status->name.service},
        {"instance", status->name.instance},
        {"process", status->process_number},
        {"state", wire::to_string(status->state)},
        {"stands_by", status->stands_by},
        {"explanation", status->explanation},
        {"counters", counters},
        {"latencies", latencies},
        {"stamp_ns", status->stamp_ns}};
  }

  static json describe(Vehicle& vehicle, std::int64_t now_ns) {
    std::erase_if(vehicle.published_ns, [now_ns, &vehicle](const auto& one) {
      const bool is_given_up = now_ns - one.second > kGivenUpAfterNs;
      if (is_given_up) vehicle.unanswered_ns.push_back(one.second);
      return is_given_up;
    });
    std::erase_if(vehicle.early_ns, [now_ns](const auto& one) {
      return now_ns - one.second.begin()->second > kGivenUpAfterNs;
    });
    json described = {{"scans", vehicle.scans},
                      {"tracked", vehicle.tracked},
                      {"unanswered", vehicle.unanswered_ns.size()},
                      {"unanswered_ns", vehicle.unanswered_ns},
                      {"pending", vehicle.published_ns.size()},
                      {"pose", vehicle.pose},
                      {"tracks", vehicle.tracks},
                      {"latencies_ms", vehicle.latencies_ms}};
    vehicle.latencies_ms.clear();
    return described;
  }

  dds::Participant participant_;
  dds::WaitSet wait_set_;
  dds::Reader<slammot_LaserScan> scans_;
  dds::Reader<slammot_LocalizedScan> localized_;
  dds::Reader<slammot_SegmentedScan> segmented_;
  dds::Reader<slammot_TrackedObjects> tracked_;
  dds::Reader<slammot_ServiceStatus> statuses_;
  std::map<std::string, Vehicle> vehicles_;
  std::map<std::string, json> services_;
};

/// Exit code: 0 if the service has done it, 1 if it refused, 2 without an answer.
int send(std::uint32_t domain_id, const std::vector<std::string>& words) {
  const dds::Participant participant({domain_id, "chaos-commander", std::nullopt});
  dds::WaitSet wait_set(participant);
  dds::Reader<slammot_Reply> replies(participant, dds::topics::kReply);
  dds::Writer<slammot_Command> commands(participant, dds::topics::kCommand);
  const wire::Command command{words[0], words[1], "chaos-" + std::to_string(::getpid()),
                              1,        words[2], words[3]};
  int exit_code = 2;
  wait_set.on_data(replies, [&] {
    replies.take_each([&](const slammot_Reply& reply) {
      if (wire::text(reply.requester) != command.requester) return;
      exit_code = reply.result == slammot_OUTCOME_DONE ? 0 : 1;
      std::printf("%s\n", reply.explanation);
    });
  });
  const auto give_up_at = std::chrono::steady_clock::now() + 10s;
  while (exit_code == 2 && std::chrono::steady_clock::now() < give_up_at) {
    commands.write(wire::encode(command));  // again with one number: it is executed once
    wait_set.wait(200ms);
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App command_line("Prints what the services of a domain do, a line of JSON a period.");
  std::uint32_t domain_id = 0;
  double period_s = 1.0;
  bool with_stages = false;
  std::vector<std::string> to_send;
  command_line.add_option("--domain", domain_id)->envname("SLAMMOT_DOMAIN");
  command_line.add_option("--period", period_s)->check(CLI::Range(0.01, 3600.0));
  command_line.add_flag("--stages", with_stages, "Also the latency to segmented scans");
  command_line.add_option("--send", to_send, "VEHICLE SERVICE VERB ARGUMENT")->expected(4);
  CLI11_PARSE(command_line, argc, argv);
  if (!to_send.empty()) return send(domain_id, to_send);
  std::atomic<Observer*> running = nullptr;
  const app::StopSignal stop_signal([&] {
    if (Observer* observer = running) observer->stop();
  });
  Observer observer(domain_id, with_stages);
  running = &observer;
  const auto period =
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(period_s));
  for (auto due = std::chrono::steady_clock::now() + period;; due += period) {
    while (std::chrono::steady_clock::now() < due) {
      if (!observer.wait(std::max(due - std::chrono::steady_clock::now(), 0ns))) return 0;
    }
    std::printf("%s\n", observer.line().dump().c_str());
    std::fflush(stdout);
  }
}
