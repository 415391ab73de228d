#include "services/slammot/convert_command.hpp"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "common/files/failure.hpp"
#include "services/gateway/recording_conversion.hpp"
#include "services/gateway/ros2_format.hpp"
#include "services/slammot/command_line.hpp"

namespace slammot {
namespace {

struct ConvertOptions {
  std::string file;
  std::string output;
  std::string vehicle_id;
  std::string format = "foxglove";
};

int convert(const ConvertOptions& options) {
  const auto recording = mcap::File::open(options.file);
  if (!recording) return files::fail(recording.error().message);
  for (const std::string& damage : recording->contents().damage)
    std::fprintf(stderr, "slammot: %s\n", damage.c_str());
  const auto format =
      options.format == "ros2" ? gateway::ros2_format() : gateway::foxglove_format();
  const gateway::ConvertedRecording converted =
      gateway::convert_recording(*recording, options.output, *format, options.vehicle_id);
  if (!converted.fault.empty()) return files::fail(converted.fault);
  std::printf("%s: %llu messages of vehicle %s\n", options.output.c_str(),
              static_cast<unsigned long long>(converted.messages), converted.vehicle_id.c_str());
  if (converted.dropped > 0)
    std::printf("malformed and left out: %llu\n",
                static_cast<unsigned long long>(converted.dropped));
  return recording->contents().damage.empty() ? kExitDone : kExitLogIsCut;
}

int convert_or_fail(const ConvertOptions& options) {
  try {
    return convert(options);
  } catch (const std::runtime_error& fault) { return files::fail(fault.what()); }
}

}  // namespace

void add_convert_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.get_subcommand("bag")->add_subcommand(
      "convert", "Write what viewers of the drive were sent, as Foxglove's or as ROS 2's messages");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("file", options->file, "Recording")->required()->type_name("FILE");
  command->add_option("--output", options->output, "File to write")->required()->type_name("FILE");
  command->add_option("--vehicle", options->vehicle_id, "Of several; default: the first in it");
  command
      ->add_option("--format", options->format,
                   "foxglove: with its schemas; ros2: standard messages of ROS 2")
      ->check(CLI::IsMember({"foxglove", "ros2"}))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = convert_or_fail(*options); });
}

}  // namespace slammot
