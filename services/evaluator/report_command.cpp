#include "services/evaluator/report_command.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/comparison_page.hpp"
#include "services/evaluator/report_page.hpp"
#include "services/evaluator/result_of_record.hpp"

namespace slammot::evaluator {
namespace {

using std::filesystem::path;

struct ReportOptions {
  ComparisonOptions comparison;
  std::vector<path> results;  ///< Named without an option: one to show, or two to compare.
  path output;
  std::vector<std::uint32_t> tracks;
};

std::string title_of(const path& folder) {
  const path whole = std::filesystem::absolute(folder).lexically_normal();  // Resolves "." to a
                                                                            // name.
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

int write_page(const path& file, const std::string& html) {
  if (const auto fault = files::write_file_atomically(file, html))
    return files::fail(fault->message);
  std::printf("%s\n", file.c_str());
  return 0;
}

int write_report(const ReportOptions& options) {
  const ComparisonOptions& comparison = options.comparison;
  const auto result = read_result(comparison.result);
  if (!result) return files::fail(result.error().message);
  ReportSource source;
  source.title = "slammot: " + title_of(comparison.result);
  source.result = &*result;
  source.track_ids = options.tracks;
  std::optional<files::Result<Truth>> truth;
  std::optional<files::Result<Evaluation>> evaluation;
  if (!comparison.truth.empty()) {
    truth.emplace(read_truth(comparison.truth));
    if (!*truth) return files::fail(truth->error().message);
    evaluation.emplace(evaluate(*result, **truth, echo_source(comparison, *result, **truth),
                                comparison.evaluation));
    if (!*evaluation) return files::fail(evaluation->error().message);
    source.truth = &**truth;
    source.evaluation = &**evaluation;
  }
  return write_page(options.output.empty() ? comparison.result / kReportFile : options.output,
                    to_html(source));
}

/// "a" and "b", or "x/a" and "y/a" where the folders have the same name.
std::pair<std::string, std::string> names_of(const path& a, const path& b) {
  if (title_of(a) != title_of(b)) return {title_of(a), title_of(b)};
  return {a.string(), b.string()};
}

int write_comparison(const ReportOptions& options) {
  if (!options.comparison.truth.empty())
    return files::refuse(
        "--truth belongs to the report of one result; slammot eval compares with truth");
  const auto a = read_result(options.results[0]);
  if (!a) return files::fail(a.error().message);
  const auto b = read_result(options.results[1]);
  if (!b) return files::fail(b.error().message);
  const auto [name_of_a, name_of_b] = names_of(options.results[0], options.results[1]);
  return write_page(options.output.empty() ? path("comparison.html") : options.output,
                    comparison_page({name_of_a, &*a}, {name_of_b, &*b}));
}

int report(ReportOptions options) {
  if (options.results.size() == 2 && options.comparison.result.empty())
    return write_comparison(options);
  if (options.results.empty() == options.comparison.result.empty())
    return files::refuse(
        "a result is required: the folder that run or bench wrote, or two to compare");
  if (!options.results.empty()) options.comparison.result = options.results.front();
  return write_report(options);
}

}  // namespace

std::optional<files::Error> write_report_of(const files::RunRecord& record, const path& folder) {
  const auto result = result_of(record, folder);
  if (!result) return result.error();
  ReportSource source;
  source.title = "slammot: " + title_of(folder);
  source.result = &*result;
  return files::write_file_atomically(folder / kReportFile, to_html(source));
}

void add_report_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "report", "Write a page in which a drive can be played, or two results compared");
  const auto options = std::make_shared<ReportOptions>();
  command
      ->add_option("RESULT", options->results,
                   "Folder that run or bench wrote; two folders are compared")
      ->type_name("DIR")
      ->expected(0, 2);
  add_comparison_options(*command, options->comparison, TruthIs::kOptional);
  command->get_option("--result")->required(false);
  command
      ->add_option("--output", options->output,
                   "Page to write [DIR/report.html; comparison.html for two results]")
      ->type_name("FILE");
  command
      ->add_option("--tracks", options->tracks,
                   "Ids of tracks to show in detail; default: selected by the program")
      ->delimiter(',')
      ->type_name("ID,ID");
  command->callback([options, &exit_code] { exit_code = report(*options); });
}

}  // namespace slammot::evaluator
