#include "services/evaluator/eval_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/evaluation_text.hpp"

namespace slammot::evaluator {
namespace {

/// Does nothing unless requested.
std::optional<files::Error> evaluate_walls(const ComparisonOptions& options,
                                           const RunResult& result, Evaluation& evaluation) {
  if (options.evaluation.walls.cell_size_m <= 0.0) return std::nullopt;
  const auto log = log_of(options);
  if (!log) return files::Error{"--wall-cell needs the log of the drive: --input FILE"};
  auto walls = wall_sharpness(*log, localized_in_world(result, evaluation.corrected),
                              result.sweep_s, options.evaluation.walls);
  if (!walls) return walls.error();
  evaluation.walls = std::move(*walls);
  return std::nullopt;
}

int evaluate_run(const ComparisonOptions& options) {
  const auto truth = read_truth(options.truth);
  if (!truth) return files::fail(truth.error());
  const auto result = read_result(options.result);
  if (!result) return files::fail(result.error());
  auto evaluation =
      evaluate(*result, *truth, echo_source(options, *result, *truth), options.evaluation);
  if (!evaluation) return files::fail(evaluation.error());
  if (const auto fault = evaluate_walls(options, *result, *evaluation)) return files::fail(*fault);
  std::fputs(to_text(*evaluation, options.evaluation).c_str(), stdout);
  const std::filesystem::path json = options.result / "evaluation.json";
  if (const auto fault =
          files::write_file_atomically(json, to_json_text(*evaluation, options.evaluation)))
    return files::fail(*fault);
  std::printf("all figures are in %s\n", json.c_str());
  return 0;
}

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "eval",
      "Compare the outputs of a run with ground truth; prints a table, writes evaluation.json");
  const auto options = std::make_shared<ComparisonOptions>();
  add_comparison_options(*command, *options, TruthIs::kRequired);
  command
      ->add_option("--wall-cell", options->evaluation.walls.cell_size_m,
                   "Compare the sharpness of maps with such cells, by the result's poses and by "
                   "the true ones [m]")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  command
      ->add_option("--wall-range", options->evaluation.walls.longest_range_m,
                   "Longest range of echoes in those maps [m]")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command->callback([options, &exit_code] { exit_code = evaluate_run(*options); });
}

}  // namespace slammot::evaluator
