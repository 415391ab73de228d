#include "services/evaluator/eval_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/number_option.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/doubts.hpp"
#include "services/evaluator/evaluation_text.hpp"
#include "services/evaluator/vehicle_boxes_csv.hpp"

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

struct EvalOptions {
  ComparisonOptions comparison;
  bool writes_boxes = false;
};

std::optional<files::Error> write_files(const EvalOptions& options, const Evaluation& evaluation) {
  const std::filesystem::path& folder = options.comparison.result;
  if (options.writes_boxes) {
    if (auto fault = files::write_file_atomically(folder / "vehicle_boxes.csv",
                                                  vehicle_boxes_csv(evaluation)))
      return fault;
  }
  return files::write_file_atomically(folder / "evaluation.json",
                                      to_json_text(evaluation, options.comparison.evaluation));
}

int evaluate_run(const EvalOptions& options) {
  const ComparisonOptions& comparison = options.comparison;
  const auto truth = read_truth(comparison.truth);
  if (!truth) return files::fail(truth.error());
  const auto result = read_result(comparison.result);
  if (!result) return files::fail(result.error());
  auto evaluation =
      evaluate(*result, *truth, echo_source(comparison, *result, *truth), comparison.evaluation);
  if (!evaluation) return files::fail(evaluation.error());
  if (const auto fault = evaluate_walls(comparison, *result, *evaluation))
    return files::fail(*fault);
  std::fputs(to_text(*evaluation, comparison.evaluation).c_str(), stdout);
  if (const auto before = time_before_located(*result)) std::printf("%s\n", before->what.c_str());
  if (const auto fault = write_files(options, *evaluation)) return files::fail(*fault);
  std::printf("all figures are in %s\n", (comparison.result / "evaluation.json").c_str());
  return evaluation->motion_differs ? 1 : 0;
}

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "eval",
      "Compare the outputs of a run with ground truth; prints a table, writes evaluation.json");
  const auto options = std::make_shared<EvalOptions>();
  add_comparison_options(*command, options->comparison, TruthIs::kRequired);
  command->add_flag("--boxes", options->writes_boxes,
                    "Also write vehicle_boxes.csv, a row for each box that the errors of vehicles "
                    "are made of");
  command
      ->add_option("--wall-cell", options->comparison.evaluation.walls.cell_size_m,
                   "Compare the sharpness of maps with such cells, by the result's poses and by "
                   "the true ones [m]")
      ->check(files::positive_number())
      ->type_name("M");
  command
      ->add_option("--wall-range", options->comparison.evaluation.walls.longest_range_m,
                   "Longest range of echoes in those maps [m]")
      ->capture_default_str()
      ->check(files::positive_number());
  command->callback([options, &exit_code] { exit_code = evaluate_run(*options); });
}

}  // namespace slammot::evaluator
