#include "services/recorder/record_command.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/app/log.hpp"
#include "common/app/service_options.hpp"
#include "common/app/stop_signal.hpp"
#include "common/dds/exit_watchdog.hpp"
#include "common/files/failure.hpp"
#include "services/recorder/recorder_service.hpp"

namespace slammot::recorder {
namespace {

struct RecordOptions {
  app::ServiceOptions service;
  RecorderService::Settings recorder;
};

int record(const RecordOptions& options) {
  dds::ExitWatchdog watchdog;
  app::ServiceContext context(RecorderService::kName, options.service);
  const app::StopSignal stop_signal([&] { context.stop(); });
  RecorderService recorder(context, options.recorder);
  context.run();
  const bool is_complete = recorder.finish();
  const Recording& recording = recorder.recording();
  std::printf("%s: %llu messages of %zu topics, %llu dropped\n", recorder.path().c_str(),
              static_cast<unsigned long long>(recording.recorded()), recorder.topic_count(),
              static_cast<unsigned long long>(recording.dropped()));
  std::fflush(stdout);
  watchdog.arm();
  return is_complete ? 0 : files::fail("recording has stopped: " + recording.fault());
}

int record_or_fail(RecordOptions options) {
  options.recorder.ends_on_fault = true;
  options.service.state_dir = ".";
  app::set_up_log(RecorderService::kName);
  try {
    return record(options);
  } catch (const std::runtime_error& fault) { return files::fail(fault.what()); }
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("record", "Record topics of the bus into an MCAP file until Ctrl-C");
  const auto options = std::make_shared<RecordOptions>();
  RecorderService::add_options(*command, options->recorder);
  command->add_option("--vehicle", options->service.vehicle_id, "Name of the file without --output")
      ->envname("SLAMMOT_VEHICLE")
      ->capture_default_str();
  app::add_domain_option(*command, options->service.domain_id);
  command
      ->add_option("--config", options->service.config_files,
                   "Files of settings to keep in the recording")
      ->type_name("FILE");
  command->callback([options, &exit_code] { exit_code = record_or_fail(*options); });
}

}  // namespace slammot::recorder
