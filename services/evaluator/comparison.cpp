#include "services/evaluator/comparison.hpp"

#include <numbers>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/number_option.hpp"
#include "services/evaluator/table_file.hpp"

namespace slammot::evaluator {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Options that select the objects and tracks that count.
void add_counting_rule(CLI::App& command, metrics::CountingRule& rule) {
  command.add_option("--range", rule.range_m, "Objects farther away do not count [m]")
      ->capture_default_str()
      ->check(files::positive_number());
  command
      .add_option_function<std::pair<double, double>>(
          "--bearings",
          [&rule](const auto& deg) {
            rule.first_bearing_rad = deg.first * kDegree,
            rule.last_bearing_rad = deg.second * kDegree;
          },
          "Only objects with a bearing between these two count: "
          "FROM TO, positive to the left of the vehicle's axis [deg]")
      ->check(files::any_number())
      ->type_name("DEG DEG");
  command.add_option("--min-speed", rule.least_speed_mps, "Slower objects do not count [m/s]")
      ->capture_default_str()
      ->check(files::not_negative_number());
  command.add_option("--min-points", rule.least_points, "Objects with fewer echoes do not count")
      ->capture_default_str()
      ->check(files::not_negative_number());
  command.add_option("--gate", rule.gate_m, "A match is at most this far from the true box [m]")
      ->capture_default_str()
      ->check(files::positive_number());
  command
      .add_option("--similarity-reach", rule.similarity_reach_m,
                  "Similarity is 1 - distance / this [m]")
      ->capture_default_str()
      ->check(files::positive_number());
}

}  // namespace

void add_comparison_options(CLI::App& command, ComparisonOptions& options, TruthIs truth) {
  command.add_option("--result", options.result, "Folder with the outputs of run or bench")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--truth", options.truth,
                  "Truth files without their endings: PREFIX.tum, PREFIX.objects.csv, ...")
      ->required(truth == TruthIs::kRequired)
      ->type_name("PREFIX");
  command
      .add_option("--input", options.input,
                  "Log of the drive, for figures of single echoes [PREFIX.log]")
      ->type_name("FILE");
  add_counting_rule(command, options.evaluation.rule);
  command
      .add_option("--max-stamp-difference", options.evaluation.max_stamp_difference_s,
                  "Greatest difference of stamps of a pose and its true pose [s]")
      ->capture_default_str()
      ->check(files::positive_number());
  command
      .add_option("--map-tolerance", options.evaluation.map_tolerance_m,
                  "Greatest distance of an occupied cell from a true wall [m]")
      ->capture_default_str()
      ->check(files::positive_number());
}

std::optional<std::filesystem::path> log_of(const ComparisonOptions& options) {
  return options.input.empty() ? plain_or_gz(options.truth.string() + ".log")
                               : std::optional(options.input);
}

EchoSource echo_source(const ComparisonOptions& options, const RunResult& result,
                       const Truth& truth) {
  const auto log = log_of(options);
  if (!log) return {};
  return [log = *log, &result, &truth](const auto& take) {
    return read_echoes(log, truth.trajectory, result.sweep_s, take);
  };
}

}  // namespace slammot::evaluator
