#include "services/gateway/gateway_service.hpp"

#include <algorithm>

#include <CLI/CLI.hpp>
#include <boost/asio/ip/address.hpp>

#include "common/app/log.hpp"
#include "common/app/system_clock.hpp"
#include "services/gateway/metrics.hpp"
#include "services/gateway/other_messages.hpp"
#include "services/gateway/page_files.hpp"

namespace slammot::gateway {
namespace {

using namespace std::chrono_literals;

/// More than the pipeline needs for a scan, less than a picture of the page lasts.
constexpr auto kGathering = 8ms;
constexpr double kStale_s = 3.0;
constexpr double kNoScanYet = -1.0;

bool is_loopback_address(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

/// Empty for an address.
std::string fault_of_address(const std::string& text) {
  boost::system::error_code fault;
  boost::asio::ip::make_address(text, fault);
  return fault ? "'" + text + "' is no address such as 192.168.1.7" : "";
}

WebServerSettings server_settings(const GatewayService::Settings& settings, BusCalls& calls) {
  WebServerSettings server = settings.server;
  server.access.token = settings.token;
  if (server.access.token.empty() && !is_loopback_address(server.address))
    server.access.token = new_token();
  const std::vector<std::string> viewers = origins_of_viewers();
  server.access.origins.insert(server.access.origins.end(), viewers.begin(), viewers.end());
  server.on_call = [&calls](ViewerCall call) { calls.take(std::move(call)); };
  return server;
}

std::unique_ptr<WebServer> start_server(const WebServerSettings& settings) {
  try {
    auto server = std::make_unique<WebServer>(settings);
    const bool is_local = is_loopback_address(settings.address);
    const bool has_colons = settings.address.find(':') != std::string::npos;
    const std::string host = has_colons ? "[" + settings.address + "]" : settings.address;
    app::log_info("serves http://{}:{}/", is_local ? "localhost" : host, server->port());
    if (!is_local) app::log_info("remote addresses add ?token={}", settings.access.token);
    return server;
  } catch (const std::invalid_argument& fault) {
    throw app::StartupFailure(fault.what());
  } catch (const std::runtime_error& fault) { throw app::Unavailable(fault.what()); }
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
      ->type_name("ADDRESS")
      ->check(CLI::Validator(fault_of_address, ""));
  command_line
      .add_option("--origin", settings.server.access.origins,
                  "Pages of other servers that may connect, such as https://viewer.example.org")
      ->type_name("ORIGIN");
  command_line
      .add_option("--host", settings.server.access.host_names,
                  "Names under which this machine is reached without a token, besides localhost")
      ->type_name("NAME");
  command_line
      .add_option("--page", settings.page_folder,
                  "Serve the page from this folder instead of the built-in one")
      ->check(CLI::ExistingDirectory);
}

GatewayService::GatewayService(app::ServiceContext& context, const Settings& settings)
    : context_(context),
      calls_(context),
      owned_server_(start_server(server_settings(settings, calls_))),
      server_(*owned_server_),
      drive_(server_,
             [this](const char* counter, std::string_view line) { context_.warn(counter, line); }) {
  for (PageFile& file :
       settings.page_folder.empty() ? built_in_page() : page_in(settings.page_folder))
    server_.put(file.path, std::move(file.content));
  context_.gather_for(kGathering);
  read_drive();
  read_services();
  Content alive{"text/plain; charset=utf-8", "alive\n"};
  alive.is_public = true;
  server_.put("/healthz", alive);
  report_health();
}

void GatewayService::read_drive() {
  const auto read = [&](const auto& topic) {
    context_.read(topic, app::Input::kOccasional,
                  [this](const auto& sample) { drive_.take(sample); });
  };
  read(dds::topics::kLaserScan);
  context_.read(dds::topics::kLocalizedScan, app::Input::kSteady, [this](const auto& sample) {
    if (drive_.take(sample)) last_scan_ = std::chrono::steady_clock::now();
  });
  read(dds::topics::kScanLabels);
  read(dds::topics::kTrackedObjects);
  read(dds::topics::kGnssFix);
  read(dds::topics::kStoredSubmapTile);
  read(dds::topics::kGraphCorrection);
  read(dds::topics::kConstraint);
  read(dds::topics::kTrafficWays);
  context_.every(250ms, [this] { drive_.publish_map(std::chrono::steady_clock::now()); });
}

/// False, counted and logged, if the sample is malformed.
template <typename Value>
bool GatewayService::accept(const wire::Decoded<Value>& decoded, const char* counter) {
  if (!decoded) context_.warn(counter, "dropped a sample: " + std::string(decoded.fault()));
  return static_cast<bool>(decoded);
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
