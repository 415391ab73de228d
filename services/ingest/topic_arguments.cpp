#include "services/ingest/topic_arguments.hpp"

#include <CLI/CLI.hpp>

#include "common/files/decimal.hpp"

namespace slammot::ingest {

void add_topic_options(CLI::App& command_line, files::TopicOptions& topics) {
  command_line
      .add_option("--scanners", topics.scanners,
                  "Names of the scanners to use; default: all with a known mounting")
      ->type_name("NAME[,NAME]")
      ->delimiter(',');
  command_line
      .add_option(
          "--scan-topic", topics.scan_topic,
          "Main scanner: a bag's topic, or a CARMEN name such as RLASER; default: by content")
      ->type_name("TOPIC");
  command_line
      .add_option("--odom-topic", topics.odometry_topic,
                  "Odometry of a bag: a topic, /tf for the transforms, or none")
      ->type_name("TOPIC|none");
  command_line
      .add_option(
          "--cloud-from", topics.cloud_from_m,
          "Lowest height above the base of a bag's clouds [m]; default: 0.2 below the sensor")
      ->type_name("M");
  command_line
      .add_option(
          "--cloud-to", topics.cloud_to_m,
          "Highest height above the base of a bag's clouds [m]; default: 0.2 above the sensor")
      ->type_name("M");
}

std::vector<std::string> arguments_of(const files::TopicOptions& topics) {
  constexpr int kDecimals = 6;
  std::vector<std::string> arguments;
  for (const std::string& name : topics.scanners)
    arguments.insert(arguments.end(), {"--scanners", name});
  if (!topics.scan_topic.empty())
    arguments.insert(arguments.end(), {"--scan-topic", topics.scan_topic});
  if (!topics.odometry_topic.empty())
    arguments.insert(arguments.end(), {"--odom-topic", topics.odometry_topic});
  // The form with '=' is required: a negative number looks like an option.
  if (topics.cloud_from_m)
    arguments.push_back("--cloud-from=" + files::fixed_text(*topics.cloud_from_m, kDecimals));
  if (topics.cloud_to_m)
    arguments.push_back("--cloud-to=" + files::fixed_text(*topics.cloud_to_m, kDecimals));
  return arguments;
}

}  // namespace slammot::ingest
