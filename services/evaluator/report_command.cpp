#include "services/evaluator/report_command.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/report_page.hpp"

namespace slammot::evaluator {
namespace {

using std::filesystem::path;

struct ReportOptions {
  ComparisonOptions comparison;
  path output;
  std::vector<std::uint32_t> tracks;
};

int fail(const files::Error& fault) {
  std::fprintf(stderr, "slammot: %s\n", fault.message.c_str());
  return 1;
}

/// Empty if there is no such file.
std::string content_of(const path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string title_of(const path& folder) {
  const path whole = std::filesystem::absolute(folder).lexically_normal();  // Resolves "." to a
                                                                            // name.
  return "slammot: " + (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

int write_report(const ReportOptions& options) {
  const ComparisonOptions& comparison = options.comparison;
  const auto result = read_result(comparison.result);
  if (!result) return fail(result.error());
  ReportSource source;
  source.title = title_of(comparison.result);
  source.result = &*result;
  source.report_json = content_of(comparison.result / "report.json");
  source.map_png = content_of(comparison.result / "map.png");
  source.track_ids = options.tracks;
  std::optional<files::Result<Truth>> truth;
  std::optional<files::Result<Evaluation>> evaluation;
  if (!comparison.truth.empty()) {
    truth.emplace(read_truth(comparison.truth));
    if (!*truth) return fail(truth->error());
    evaluation.emplace(evaluate(*result, **truth, echo_source(comparison, *result, **truth),
                                comparison.evaluation));
    if (!*evaluation) return fail(evaluation->error());
    source.truth = &**truth;
    source.evaluation = &**evaluation;
  }
  const path output = options.output.empty() ? comparison.result / "report.html" : options.output;
  if (const auto fault = files::write_file_atomically(output, to_html(source))) return fail(*fault);
  std::printf("%s\n", output.c_str());
  return 0;
}

}  // namespace

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "report", "Write an HTML page about a run: map, tracks, errors, latencies");
  const auto options = std::make_shared<ReportOptions>();
  add_comparison_options(*command, options->comparison, TruthIs::kOptional);
  command->add_option("--output", options->output, "Page to write [DIR/report.html]")
      ->type_name("FILE");
  command
      ->add_option("--tracks", options->tracks,
                   "Ids of tracks to show in detail; default: selected by the program")
      ->delimiter(',')
      ->type_name("ID,ID");
  command->callback([options, &exit_code] { exit_code = write_report(*options); });
}

}  // namespace slammot::evaluator
