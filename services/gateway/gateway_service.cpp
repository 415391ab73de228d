#include "services/gateway/gateway_service.hpp"

#include <algorithm>

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "common/app/system_clock.hpp"
#include "common/wire/localized_scan.hpp"
#include "common/wire/scan_labels.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/tracked_objects.hpp"
#include "services/gateway/metrics.hpp"
#include "services/gateway/other_messages.hpp"
#include "services/gateway/page_files.hpp"
#include "services/gateway/pose_messages.hpp"
#include "services/gateway/scan_messages.hpp"
#include "services/gateway/track_messages.hpp"

namespace slammot::gateway {
namespace {

using namespace std::chrono_literals;

constexpr double kStale_s = 3.0;
constexpr double kNoScanYet = -1.0;

bool is_loopback_address(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

WebServerSettings server_settings(const GatewayService::Settings& settings) {
  WebServerSettings server = settings.server;
  server.access.token = settings.token;
  if (server.access.token.empty() && !is_loopback_address(server.address))
    server.access.token = new_token();
  const std::vector<std::string> viewers = origins_of_viewers();
  server.access.origins.insert(server.access.origins.end(), viewers.begin(), viewers.end());
  return server;
}

std::unique_ptr<WebServer> start_server(const WebServerSettings& settings) {
  try {
    auto server = std::make_unique<WebServer>(settings);
    const bool is_local = is_loopback_address(settings.address);
    spdlog::info("serves http://{}:{}/", is_local ? "localhost" : settings.address, server->port());
    if (!is_local) spdlog::info("remote addresses add ?token={}", settings.access.token);
    return server;
  } catch (const std::runtime_error& fault) { throw app::StartupFailure(fault.what()); }
}

/// Tells a standby from its leader, which often has the same name.
template <typename Message>
void name_standby(Message& message) {
  if (message.stands_by) message.name.instance += " (standby)";
}

/// Answer to the question whether there is anything to see.
Content readiness(double scan_age_s) {
  const bool is_ready = scan_age_s >= 0.0 && scan_age_s < kStale_s;
  Content content{"text/plain; charset=utf-8", is_ready           ? "ready\n"
                                               : scan_age_s < 0.0 ? "no scan yet\n"
                                                                  : "no scan for a while\n"};
  content.status = is_ready ? 200 : 503;
  return content;
}

}  // namespace

void GatewayService::add_options(CLI::App& command_line, Settings& settings) {
  command_line.add_option("--port", settings.server.port, "Port to serve; 0: any free one")
      ->capture_default_str();
  command_line
      .add_option("--address", settings.server.address,
                  "Address to serve; 0.0.0.0: all, where remote addresses need the token")
      ->capture_default_str();
  command_line
      .add_option("--token", settings.token,
                  "Asked of remote addresses; default: a new one, shown in the log")
      ->envname("SLAMMOT_TOKEN");
  command_line
      .add_option("--trust", settings.server.access.trusted_addresses,
                  "Remote addresses that need no token")
      ->type_name("ADDRESS");
  command_line
      .add_option("--origin", settings.server.access.origins,
                  "Pages of other servers that may connect, such as https://viewer.example.org")
      ->type_name("ORIGIN");
  command_line
      .add_option("--host", settings.server.access.host_names,
                  "Names under which this machine is reached without a token, besides localhost")
      ->type_name("NAME");
  command_line.add_option("--page", settings.page_folder,
                          "Serve the page from this folder instead of the built-in one");
}

GatewayService::GatewayService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      owned_server_(start_server(server_settings(settings))),
      server_(*owned_server_),
      pairing_([this](const flow::LocalizedScan& scan, const auto& labels) {
        if (server_.is_wanted(ChannelId::kPoints))
          server_.publish(ChannelId::kPoints, scan.stamp_ns,
                          labelled_points_message(scan, labels).SerializeAsString());
      }),
      map_(server_) {
  for (PageFile& file :
       settings.page_folder.empty() ? built_in_page() : page_in(settings.page_folder))
    server_.put(file.path, std::move(file.content));
  const auto read = [&](const auto& topic, app::Input kind) {
    context.read(topic, kind, [this](const auto& sample) { this->take(sample); });
  };
  read(dds::topics::kLaserScan, app::Input::kOccasional);
  read(dds::topics::kLocalizedScan, app::Input::kSteady);
  read(dds::topics::kScanLabels, app::Input::kOccasional);
  read(dds::topics::kTrackedObjects, app::Input::kOccasional);
  read(dds::topics::kGnssFix, app::Input::kOccasional);
  read_map();
  read_services();
  Content alive{"text/plain; charset=utf-8", "alive\n"};
  alive.is_public = true;
  server_.put("/healthz", alive);
  report_health();
}

template <typename Value>
bool GatewayService::accept(const wire::Decoded<Value>& decoded, const char* counter) {
  if (!decoded) context_.warn(counter, "dropped a sample: " + std::string(decoded.fault()));
  return static_cast<bool>(decoded);
}

void GatewayService::take(const slammot_LaserScan& sample) {
  if (!server_.is_wanted(ChannelId::kScan)) return;
  const auto scan = wire::decode(sample);
  if (accept(scan, "faulty_scans"))
    server_.publish(ChannelId::kScan, scan->stamp_ns,
                    laser_scan_message(*scan).SerializeAsString());
}

void GatewayService::take(const slammot_LocalizedScan& sample) {
  auto scan = wire::decode(sample);
  if (!accept(scan, "faulty_localized_scans")) return;
  last_scan_ = std::chrono::steady_clock::now();
  map_.follow(*scan);
  const auto publish = [&](ChannelId channel, const auto& message_of) {
    if (server_.is_wanted(channel)) server_.publish(channel, scan->stamp_ns, message_of());
  };
  publish(ChannelId::kPose, [&] { return pose_message(*scan).SerializeAsString(); });
  publish(ChannelId::kTransforms, [&] { return transforms_message(*scan).SerializeAsString(); });
  publish(ChannelId::kPoseDetails, [&] { return pose_json(*scan); });
  pairing_.take(std::move(*scan));
}

void GatewayService::take(const slammot_ScanLabels& sample) {
  const auto labels = wire::decode(sample);
  if (accept(labels, "faulty_scan_labels")) pairing_.take(*labels);
}

void GatewayService::take(const slammot_TrackedObjects& sample) {
  const bool wants_scene = server_.is_wanted(ChannelId::kTracks);
  const bool wants_details = server_.is_wanted(ChannelId::kTrackDetails);
  if (!wants_scene && !wants_details) return;
  const auto objects = wire::decode(sample);
  if (!accept(objects, "faulty_tracks")) return;
  if (wants_scene)
    server_.publish(ChannelId::kTracks, objects->stamp_ns,
                    scene_message(*objects, shown_tracks_).SerializeAsString());
  shown_tracks_ = drawn_tracks(*objects);
  if (wants_details)
    server_.publish(ChannelId::kTrackDetails, objects->stamp_ns, tracks_json(*objects));
}

void GatewayService::take(const slammot_GnssFix& sample) {
  if (!server_.is_wanted(ChannelId::kFix)) return;
  const auto fix = wire::decode(sample);
  if (accept(fix, "faulty_fixes"))
    server_.publish(ChannelId::kFix, fix->stamp_ns, fix_message(*fix).SerializeAsString());
}

void GatewayService::read_map() {
  const auto report = [this](const char* counter, std::string_view fault) {
    if (!fault.empty()) context_.warn(counter, "dropped a part of the map: " + std::string(fault));
  };
  context_.read(dds::topics::kStoredSubmapTile, app::Input::kOccasional,
                [this, report](const auto& tile) { report("faulty_tiles", map_.take(tile)); });
  context_.read(
      dds::topics::kGraphCorrection, app::Input::kOccasional,
      [this, report](const auto& part) { report("faulty_corrections", map_.take(part)); });
  context_.read(dds::topics::kConstraint, app::Input::kOccasional, [this](const auto& sample) {
    const auto constraint = wire::decode(sample);
    if (accept(constraint, "faulty_constraints")) map_.take(*constraint);
  });
  context_.every(250ms, [this] { map_.publish(std::chrono::steady_clock::now()); });
}

void GatewayService::read_services() {
  context_.read(dds::topics::kHeartbeat, app::Input::kOccasional, [this](const auto& sample) {
    auto heartbeat = wire::decode(sample);
    if (heartbeat) name_standby(*heartbeat);
    if (accept(heartbeat, "faulty_heartbeats"))
      board_.take(*heartbeat, std::chrono::steady_clock::now());
  });
  context_.read(dds::topics::kStatus, app::Input::kOccasional, [this](const auto& sample) {
    auto status = wire::decode(sample);
    if (status) name_standby(*status);
    if (accept(status, "faulty_statuses")) board_.take(*status, std::chrono::steady_clock::now());
  });
  context_.every(500ms, [this] { report_health(); });
}

GatewayFigures GatewayService::figures(app::SteadyTime now) const {
  const HubCounters hub = server_.counters();
  const double age_s =
      last_scan_ ? std::chrono::duration<double>(now - *last_scan_).count() : kNoScanYet;
  return {hub.viewers, hub.dropped_messages, hub.sent_bytes, resident_memory_mb(), age_s};
}

void GatewayService::report_health() {
  const auto now = std::chrono::steady_clock::now();
  board_.forget(now);
  const HubCounters hub = server_.counters();
  server_.publish(ChannelId::kHealth, app::system_clock_ns(),
                  health_json(board_, figures(now), now));
  server_.put("/metrics", {"text/plain; version=0.0.4; charset=utf-8",
                           metrics_text(context_.vehicle_id(), board_, hub, figures(now), now)});
  server_.put("/readyz", readiness(figures(now).scan_age_s));
  log_warnings(board_.warnings(now));
  context_.status().counter("viewers") = hub.viewers;
  context_.status().counter("sent_messages") = hub.sent_messages;
  context_.status().counter("dropped_messages") = hub.dropped_messages;
}

/// Logs a warning when it begins. The time in it grows: only the words before are compared.
void GatewayService::log_warnings(const std::vector<std::string>& warnings) {
  std::set<std::string> kinds;
  for (const std::string& warning : warnings) {
    const std::string kind = warning.substr(0, warning.find_first_of("0123456789"));
    kinds.insert(kind);
    if (!warnings_.contains(kind))
      server_.publish(ChannelId::kLog, app::system_clock_ns(),
                      log_message(app::system_clock_ns(), warning).SerializeAsString());
  }
  warnings_ = std::move(kinds);
}

}  // namespace slammot::gateway
