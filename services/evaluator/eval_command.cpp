#include "services/evaluator/eval_command.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/evaluation_text.hpp"

namespace slammot::evaluator {
namespace {

int fail(const files::Error& fault) {
  std::fprintf(stderr, "slammot: %s\n", fault.message.c_str());
  return 1;
}

int evaluate_run(const ComparisonOptions& options) {
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

}  // namespace

void add_eval_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("eval", "Compare the outputs of a run with the truth; prints a table, writes evaluation.json");
  const auto options = std::make_shared<ComparisonOptions>();
  add_comparison_options(*command, *options, TruthIs::kRequired);
  command->callback([options, &exit_code] { exit_code = evaluate_run(*options); });
}

}  // namespace slammot::evaluator
