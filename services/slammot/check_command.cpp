#include "services/slammot/check_command.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/carmen_log.hpp"
#include "common/files/failure.hpp"
#include "common/files/log_findings.hpp"
#include "common/files/log_profile.hpp"
#include "services/ingest/topic_arguments.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/job_text.hpp"
#include "services/slammot/usage.hpp"

namespace slammot {
namespace {

struct CheckOptions {
  std::filesystem::path log;
  files::TopicOptions topics;
};

std::string command_to_run(const CheckOptions& options) {
  std::filesystem::path name = options.log.filename();
  while (name.has_extension()) name = name.stem();
  std::string command = "slammot run --input " + shell_word(options.log.string()) + " --output " +
                        shell_word("out/" + name.string());
  for (const std::string& argument : ingest::arguments_of(options.topics))
    command += " " + shell_word(argument);
  return command;
}

int check(const CheckOptions& options) {
  files::CarmenLogOptions log_options;
  log_options.topics = options.topics;
  auto log = files::CarmenLog::open(options.log, log_options);
  if (!log) return files::fail(log.error());
  const files::LogPlan& plan = log->plan();
  const files::ProfileChoice profile = files::choose_profile(plan.figures);
  std::fputs(files::describe_log(plan).c_str(), stdout);
  std::fputs(files::describe(log->topics()).c_str(), stdout);
  std::printf("profile    %s (%s)\n", profile.profile.c_str(), profile.reason.c_str());
  std::vector<std::string> findings = files::describe_findings(plan);
  findings.insert(findings.end(), log->topics().doubts.begin(), log->topics().doubts.end());
  while (log->next()) {}
  for (std::string& skipped : describe_skipped(log->faults()))
    findings.push_back(std::move(skipped));
  if (log->faults().is_cut)
    findings.push_back("the file is cut off or damaged: this report covers its readable part" +
                       where_damaged(log->faults()));
  for (const std::string& finding : findings) std::printf("doubtful   %s\n", finding.c_str());
  std::printf("run it     %s\n", command_to_run(options).c_str());
  return findings.empty() ? kExitDone : kExitDoubtful;
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "check", "Report the content of a log, what will be assumed and what is doubtful");
  const auto options = std::make_shared<CheckOptions>();
  command
      ->add_option("log", options->log,
                   "Recorded drive: a CARMEN or DP-SLAM log, plain or .gz, or a ROS bag")
      ->required()
      ->type_name("FILE");
  ingest::add_topic_options(*command, options->topics);
  command->callback([options, &exit_code] { exit_code = check(*options); });
}

}  // namespace slammot
