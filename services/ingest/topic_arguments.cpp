#include "services/ingest/topic_arguments.hpp"

#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/decimal.hpp"
#include "common/files/number_option.hpp"

namespace slammot::ingest {
namespace {

void say(const std::vector<std::string>& texts, files::TopicOptions& topics) {
  for (const std::string& text : texts) {
    auto scanner = files::parse_vertical_scanner(text);
    if (!scanner) throw CLI::ValidationError(scanner.error().message);
    topics.vertical.push_back(std::move(*scanner));
  }
}

}  // namespace

void add_vertical_option(CLI::App& command_line, files::TopicOptions& topics) {
  command_line
      .add_option_function<std::vector<std::string>>(
          "--vertical", [&topics](const std::vector<std::string>& texts) { say(texts, topics); },
          "A scanner of vertical profiles and its mounting, if the log does not state it [m, "
          "degrees]: slammot model uses it, nothing else does")
      ->type_name("NAME=AHEAD,LEFT,UP,ROLL,PITCH,HEADING")
      ->allow_extra_args(false);
}

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
  add_vertical_option(command_line, topics);
  command_line
      .add_option(
          "--cloud-from", topics.cloud_from_m,
          "Lowest height above the base of a bag's clouds [m]; default: 0.2 below the sensor")
      ->check(files::any_number())
      ->type_name("M");
  command_line
      .add_option(
          "--cloud-to", topics.cloud_to_m,
          "Highest height above the base of a bag's clouds [m]; default: 0.2 above the sensor")
      ->check(files::any_number())
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
  for (const files::VerticalScanner& scanner : topics.vertical)
    arguments.insert(arguments.end(), {"--vertical", scanner.text});
  // The form with '=' is required: a negative number looks like an option.
  if (topics.cloud_from_m)
    arguments.push_back("--cloud-from=" + files::fixed_text(*topics.cloud_from_m, kDecimals));
  if (topics.cloud_to_m)
    arguments.push_back("--cloud-to=" + files::fixed_text(*topics.cloud_to_m, kDecimals));
  return arguments;
}

}  // namespace slammot::ingest
