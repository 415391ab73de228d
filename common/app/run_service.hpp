#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/app/service_context.hpp"
#include "common/config/fields.hpp"

namespace slammot::app {

/// A bad command line or configuration; also that of a StartupFailure.
inline constexpr int kExitUsage = 2;
/// An unexpected failure: the process should be restarted.
inline constexpr int kExitFailure = 1;

/// A service cannot start: one line for the user, then exit code kExitUsage. Thrown by constructors
/// of services.
class StartupFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A resource that a service needs is not available, such as room on a disk: one line for the user,
/// then exit code kExitFailure, so that a supervisor tries again. Thrown by constructors of
/// services.
class Unavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parameters of a service's main.
struct ServiceDescription {
  std::string name;     ///< Of the service on the bus.
  std::string purpose;  ///< One sentence for --help.
  std::vector<config::BoundStage> stages;
  std::function<void(CLI::App&)> add_options;
  std::function<std::shared_ptr<void>(ServiceContext&)> make;
  std::function<void(ServiceContext&)> prepare;   ///< Before it leads; may be empty.
  std::function<void(ServiceContext&)> rehearse;  ///< Of a standby; may be empty.
  bool is_one_per_vehicle = false;                ///< A second process of it stands by.
  bool keeps_state = false;                       ///< In the state directory, which is locked.
  bool gives_way = false;                         ///< To the services on the way of a scan.
};

/// Runs a service: command line, configuration, log, signals, bus, loop, exit.
int run_service(int argc, char** argv, const ServiceDescription& description);

template <typename Service>
concept IsOnePerVehicle = Service::kIsOnePerVehicle;
template <typename Service>
concept PreparesInputs = requires(ServiceContext& context) {
  Service::prepare(context);
};
template <typename Service>
concept Rehearses = requires(ServiceContext& context, const typename Service::Settings& settings) {
  Service::rehearse(context, settings);
};
template <typename Service>
concept KeepsState = Service::kKeepsState;
template <typename Service>
concept GivesWay = Service::kGivesWay;

/// The same for a class that has
///   struct Settings                      its configuration and options, with defaults,
///   static constexpr const char* kName, *kPurpose,
///   static std::vector<config::BoundStage> stages(Settings&),
///   static void add_options(CLI::App&, Settings&),
///   Service(ServiceContext&, const Settings&)
///                                        which says what it reads, writes and does periodically,
/// and, where it is true, static constexpr bool kIsOnePerVehicle, kKeepsState, kGivesWay, and for a
/// standby
///   static void prepare(ServiceContext&)  the topics that it needs the history of,
///   static void rehearse(ServiceContext&, const Settings&)
///                                        what makes its takeover faster, once it stands by.
template <typename Service>
int run_service(int argc, char** argv) {
  typename Service::Settings settings;
  ServiceDescription description{
      .name = Service::kName,
      .purpose = Service::kPurpose,
      .stages = Service::stages(settings),
      .add_options = [&](CLI::App& command_line) { Service::add_options(command_line, settings); },
      .make = [&](ServiceContext& context) { return std::make_shared<Service>(context, settings); },
      .prepare = {},
      .rehearse = {},
      .is_one_per_vehicle = IsOnePerVehicle<Service>,
      .keeps_state = KeepsState<Service>,
      .gives_way = GivesWay<Service>};
  if constexpr (PreparesInputs<Service>) description.prepare = Service::prepare;
  if constexpr (Rehearses<Service>)
    description.rehearse = [&](ServiceContext& context) { Service::rehearse(context, settings); };
  return run_service(argc, argv, description);
}

}  // namespace slammot::app
