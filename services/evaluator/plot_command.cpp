#include "services/evaluator/plot_command.hpp"

#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/number_option.hpp"
#include "services/evaluator/comparison.hpp"
#include "services/evaluator/doubts.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/model_drawing.hpp"
#include "services/evaluator/plot_drawing.hpp"
#include "services/evaluator/scene_drawing.hpp"
#include "services/evaluator/way_drawing.hpp"

namespace slammot::evaluator {
namespace {

using std::filesystem::path;

struct PlotOptions {
  std::string what;
  path result;
  path truth;
  path output;
  std::string theme = "dark";
  double size = 1600.0;  ///< Pixels along the longer side of a map.
};

Drawing draw_ground(const RunResult& result, const PlotOptions& options) {
  const GroundView view = whole_view(result, options.size);
  const PageTheme theme = page_theme(options.theme);
  const SceneDrawing scene(result, theme, view.metres_per_pixel);
  Drawing drawing = scene.ground(view);
  if (options.what == "tracks") scene.add_paths(view, drawing);
  if (options.what == "map") scene.add_closures(view, drawing);
  if (options.what == "lanes") add_ways(*result.ways, view, theme, drawing);
  else scene.add_way(view, std::numeric_limits<std::int64_t>::max(), drawing);
  scene.add_scale(view, drawing);
  return drawing;
}

std::vector<Span> doubtful_spans(const RunResult& result) {
  std::vector<Span> spans;
  const auto seconds = [&](std::int64_t stamp_ns) {
    return static_cast<double>(stamp_ns - result.online.front().stamp_ns) * 1e-9;
  };
  for (const Doubt& doubt : find_doubts(result))
    spans.push_back({seconds(doubt.begin_ns), seconds(doubt.end_ns)});
  return spans;
}

/// Errors where there is truth; otherwise the published standard deviation.
files::Result<Drawing> draw_errors(const RunResult& result, const PlotOptions& options) {
  ReportSource source;
  source.result = &result;
  std::optional<files::Result<Truth>> truth;
  std::optional<files::Result<Evaluation>> evaluation;
  if (!options.truth.empty()) {
    truth.emplace(read_truth(options.truth));
    if (!*truth) return truth->error();
    evaluation.emplace(evaluate(result, **truth, {}, {}));
    if (!*evaluation) return evaluation->error();
    source.evaluation = &**evaluation;
  }
  std::vector<CaptionedPlot> plots = error_plots(source);
  if (plots.empty()) return files::Error{"the result has no covariances; --truth gives errors"};
  for (CaptionedPlot& plot : plots) plot.plot.shaded = doubtful_spans(result);
  return draw_plots(plots);
}

files::Result<Drawing> draw_model_of(const RunResult& result, const PlotOptions& options) {
  const auto model = files::read_ply(options.result / "model.ply");
  if (!model) return model.error();
  return draw_model(*model, result.corrected, page_theme(options.theme), options.size);
}

files::Result<Drawing> draw(const RunResult& result, const PlotOptions& options) {
  if (options.what == "model") return draw_model_of(result, options);
  if (options.what == "errors") return draw_errors(result, options);
  if (options.what == "lanes" && !result.ways)
    return files::Error{(options.result / "lanes.geojson").string() + ": cannot be read"};
  if (options.what != "latency") return draw_ground(result, options);
  const std::vector<LogBar> bars = latency_bars(result.report_json);
  if (bars.empty()) return files::Error{"report.json has no latencies"};
  return draw_log_bars(bars, "milliseconds a call");
}

/// Map and lanes can be drawn without a drive: of merged maps there is none.
files::Result<RunResult> read_what_is_drawn(const PlotOptions& options) {
  const bool is_of_map = options.what == "map" || options.what == "lanes";
  std::error_code ignored;
  const bool has_drive = std::filesystem::exists(options.result / "online.tum", ignored);
  return is_of_map && !has_drive ? read_map_folder(options.result) : read_result(options.result);
}

int plot(const PlotOptions& options) {
  constexpr double kSharp = 2.0;  // pixels a unit, of plots with text
  const path output =
      options.output.empty() ? options.result / (options.what + "_plot.png") : options.output;
  if (output.extension() != ".png" && output.extension() != ".svg")
    return files::refuse("--output " + output.string() + ": the name must end with .png or .svg");
  const auto result = read_what_is_drawn(options);
  if (!result) return files::fail(result.error().message);
  const auto drawing = draw(*result, options);
  if (!drawing) return files::fail(drawing.error().message);
  std::string content;
  if (output.extension() == ".svg") {
    content = to_svg(*drawing);
  } else {
    const bool is_map = options.what != "latency" && options.what != "errors";
    const auto png = files::to_png(to_pixels(*drawing, is_map ? 1.0 : kSharp));
    if (!png) return files::fail(png.error().message);
    content = *png;
  }
  if (const auto fault = files::write_file_atomically(output, content))
    return files::fail(fault->message);
  std::printf("%s\n", output.c_str());
  return 0;
}

}  // namespace

void add_plot_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "plot", "Draw map, tracks, lanes, latencies, errors or the 2.5-D model of a result");
  const auto options = std::make_shared<PlotOptions>();
  command->add_option("what", options->what, "What to draw")
      ->required()
      ->type_name("map|tracks|lanes|latency|errors|model")
      ->check(CLI::IsMember({"map", "tracks", "lanes", "latency", "errors", "model"}));
  command
      ->add_option("result", options->result,
                   "Folder that run, bench or (map, lanes) map merge wrote")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--output", options->output,
                   "Picture to write, .png or .svg [DIR/WHAT_plot.png]")
      ->type_name("FILE");
  command
      ->add_option("--truth", options->truth,
                   "Prefix of the true files: errors in place of standard deviations")
      ->type_name("PREFIX");
  command
      ->add_option("--theme", options->theme,
                   "Colours of map, tracks, lanes and model: dark or light")
      ->type_name("dark|light")
      ->check(CLI::IsMember({"dark", "light"}))
      ->capture_default_str();
  command
      ->add_option("--size", options->size,
                   "Pixels along the longer side of map, tracks, lanes and model")
      ->type_name("N")
      ->check(files::number_between(64.0, 16384.0))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = plot(*options); });
}

}  // namespace slammot::evaluator
