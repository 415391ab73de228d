#include "services/evaluator/eval_command.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "services/evaluator/evaluation.hpp"
#include "services/evaluator/evaluation_text.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

struct EvalOptions {
  std::filesystem::path result;
  std::filesystem::path truth;
  std::filesystem::path input;
  EvaluationOptions evaluation;
};

int fail(const files::Error& fault) {
  std::fprintf(stderr, "slammot: %s\n", fault.message.c_str());
  return 1;
}

/// From the log asked for, or the one beside the truth.
EchoSource echo_source(const EvalOptions& options, const RunResult& result, const Truth& truth) {
  const auto log = options.input.empty() ? plain_or_gz(options.truth.string() + ".log") : std::optional(options.input);
  if (!log) return {};
  return [log = *log, &result, &truth](const auto& take) { return read_echoes(log, truth.trajectory, result.sweep_s, take); };
}

int evaluate_run(const EvalOptions& options) {
  const auto truth = read_truth(options.truth);
  if (!truth) return fail(truth.error());
  const auto result = read_result(options.result);
  if (!result) return fail(result.error());
  const auto evaluation = evaluate(*result, *truth, echo_source(options, *result, *truth), options.evaluation);
  if (!evaluation) return fail(evaluation.error());
  std::fputs(to_text(*evaluation, options.evaluation).c_str(), stdout);
  const std::filesystem::path json = options.result / "evaluation.json";
  if (const auto fault = files::write_file_atomically(json, to_json_text(*evaluation, options.evaluation))) return fail(*fault);
  std::printf("all figures are in %s\n", json.c_str());
  return 0;
}

void add_options(CLI::App& command, EvalOptions& options) {
  metrics::CountingRule& rule = options.evaluation.rule;
  command.add_option("--result", options.result, "Folder with the outputs of run or bench")->required()->type_name("DIR");
  command.add_option("--truth", options.truth, "Truth files without their endings: PREFIX.tum, PREFIX.objects.csv, ...")->required()->type_name("PREFIX");
  command.add_option("--input", options.input, "Log of the drive, for what is judged echo by echo [PREFIX.log]")->type_name("FILE");
  command.add_option("--range", rule.range_m, "Objects farther away do not count [m]")->capture_default_str()->check(CLI::PositiveNumber);
  command.add_option("--min-speed", rule.least_speed_mps, "Slower objects do not count [m/s]")->capture_default_str()->check(CLI::NonNegativeNumber);
  command.add_option("--min-points", rule.least_points, "Objects with fewer echoes do not count")->capture_default_str()->check(CLI::NonNegativeNumber);
  command.add_option("--gate", rule.gate_m, "A match is at most this far from the true box [m]")->capture_default_str()->check(CLI::PositiveNumber);
  command.add_option("--similarity-reach", rule.similarity_reach_m, "Similarity is 1 - distance / this [m]")->capture_default_str()->check(CLI::PositiveNumber);
  command.add_option("--max-stamp-difference", options.evaluation.max_stamp_difference_s, "Between a pose and its true one [s]")->capture_default_str()->check(CLI::PositiveNumber);
  command.add_option("--map-tolerance", options.evaluation.map_tolerance_m, "From an occupied cell to a true wall [m]")->capture_default_str()->check(CLI::PositiveNumber);
}

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("eval", "Compare the outputs of a run with the truth; prints a table, writes evaluation.json");
  const auto options = std::make_shared<EvalOptions>();
  add_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = evaluate_run(*options); });
}

}  // namespace slammot::evaluator
