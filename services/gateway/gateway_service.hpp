#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/run_service.hpp"
#include "services/gateway/bus_calls.hpp"
#include "services/gateway/drive_messages.hpp"
#include "services/gateway/service_board.hpp"
#include "services/gateway/web_server.hpp"

namespace slammot::gateway {

/// Shows what is on the bus to viewers: decodes, converts, and hands over to the server.
class GatewayService {
 public:
  struct Settings {
    WebServerSettings server;
    std::string token;                  ///< Empty: a new one if remote addresses may connect.
    std::filesystem::path page_folder;  ///< Empty: the built-in page.
  };
  static constexpr const char* kName = "gateway";
  static constexpr const char* kPurpose =
      "Shows map, tracks and health in the browser and in viewers that speak Foxglove's protocol.";
  static constexpr bool kGivesWay = true;
  static std::vector<config::BoundStage> stages(Settings&) { return {}; }
  static void add_options(CLI::App& command_line, Settings& settings);

  /// Throws app::Unavailable if the port cannot be served, app::StartupFailure for a wrong address.
  GatewayService(app::ServiceContext& context, const Settings& settings);

  std::uint16_t port() const { return server_.port(); }

 private:
  void read_drive();
  void read_services();
  void report_health();
  void log_warnings(const std::vector<std::string>& warnings);
  GatewayFigures figures(app::SteadyTime now) const;
  template <typename Value>
  bool accept(const wire::Decoded<Value>& decoded, const char* counter);

  app::ServiceContext& context_;
  BusCalls calls_;  ///< Outlives the server, whose thread hands calls over.
  std::unique_ptr<WebServer> owned_server_;
  WebServer& server_;
  DriveMessages drive_;
  ServiceBoard board_;
  std::set<std::string> warnings_;
  std::optional<app::SteadyTime> last_scan_;
};

}  // namespace slammot::gateway
