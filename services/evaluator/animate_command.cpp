#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/files/animated_png.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/number_option.hpp"
#include "common/files/text.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/plot_command.hpp"
#include "services/evaluator/scene_drawing.hpp"

namespace slammot::evaluator {
namespace {

using std::filesystem::path;

struct AnimateOptions {
  path result;
  path output;
  std::optional<double> from_s;
  double length_s = 20.0;  ///< Of the drive.
  double speed = 2.0;
  double rate_hz = 8.0;
  double width = 640.0;
  double height = 400.0;
  double across_m = 90.0;  ///< Along the width.
  std::string theme = "dark";
};

double seconds_of(const RunResult& result, std::int64_t stamp_ns) {
  return static_cast<double>(stamp_ns - result.corrected.front().stamp_ns) * 1e-9;
}

/// Begin of the stretch of this length with the most moving tracks.
double liveliest_s(const RunResult& result, double length_s) {
  constexpr double kStepS = 1.0;
  const double end_s = seconds_of(result, result.corrected.back().stamp_ns);
  std::vector<double> moving(static_cast<std::size_t>(end_s / kStepS) + 1);
  for (const TracksAt& at : result.tracks) {
    const double at_s = seconds_of(result, at.stamp_ns);
    if (at_s < 0.0 || at_s > end_s) continue;
    moving[static_cast<std::size_t>(at_s / kStepS)] += static_cast<double>(
        std::ranges::count_if(at.tracks, [](const ResultTrack& track) { return track.is_moving; }));
  }
  const std::size_t span = std::min(moving.size(), static_cast<std::size_t>(length_s / kStepS) + 1);
  double most = -1.0;
  std::size_t best = 0;
  for (std::size_t begin = 0; begin + span <= moving.size(); ++begin) {
    const auto first = moving.begin() + static_cast<std::ptrdiff_t>(begin);
    const double sum = std::accumulate(first, first + static_cast<std::ptrdiff_t>(span), 0.0);
    if (sum <= most) continue;
    most = sum;
    best = begin;
  }
  return static_cast<double>(best) * kStepS;
}

/// Pose between the two nearest ones: scans are rarer than pictures.
geometry::Vector2 place_at(const RunResult& result, std::int64_t stamp_ns) {
  const auto after =
      std::ranges::lower_bound(result.corrected, stamp_ns, {}, &metrics::StampedPose::stamp_ns);
  if (after == result.corrected.begin() || after == result.corrected.end())
    return pose_near(result.corrected, stamp_ns).translation_m();
  const auto before = std::prev(after);
  const double part =
      static_cast<double>(stamp_ns - before->stamp_ns) /
      static_cast<double>(std::max<std::int64_t>(1, after->stamp_ns - before->stamp_ns));
  return interpolate(before->pose, after->pose, part).translation_m();
}

Drawing frame_at(const RunResult& result, const SceneDrawing& scene, const AnimateOptions& options,
                 double at_s) {
  const std::int64_t stamp_ns =
      result.corrected.front().stamp_ns + static_cast<std::int64_t>(std::llround(at_s * 1e9));
  GroundView view;
  view.width = options.width;
  view.height = options.height;
  view.metres_per_pixel = options.across_m / options.width;
  // On whole pixels: what stands then looks the same in each picture, which compresses.
  const geometry::Vector2 corner_m =
      place_at(result, stamp_ns) +
      0.5 * view.metres_per_pixel * geometry::Vector2(-view.width, view.height);
  view.upper_left_m = view.metres_per_pixel * (corner_m / view.metres_per_pixel).array().round();
  Drawing drawing = scene.ground(view);
  scene.add_way(view, stamp_ns, drawing);
  scene.add_tracks(view, stamp_ns, drawing);
  scene.add_vehicle(view, stamp_ns, drawing);
  scene.add_scale(view, drawing);
  drawing.marks.emplace_back(
      TextMark{{12.0, options.height - 12.0},
               files::text("%d:%04.1f", static_cast<int>(at_s / 60.0), std::fmod(at_s, 60.0)),
               {scene.colour("vehicle"), 0.8},
               12.0});
  return drawing;
}

int animate(const AnimateOptions& options) {
  constexpr std::size_t kMostFrames = 2000;
  const auto result = read_result(options.result);
  if (!result) return files::fail(result.error().message);
  const double end_s = seconds_of(*result, result->corrected.back().stamp_ns);
  if (options.from_s && *options.from_s > end_s)
    return files::refuse(
        files::text("--from %g: the drive ends at %.1f s", *options.from_s, end_s));
  const double length_s = std::min(options.length_s, end_s);
  const double from_s = std::clamp(options.from_s.value_or(liveliest_s(*result, length_s)), 0.0,
                                   std::max(0.0, end_s - length_s));
  const double step_s = options.speed / options.rate_hz;
  const auto count = static_cast<std::size_t>(length_s / step_s) + 1;
  if (count > kMostFrames)
    return files::fail("more than " + std::to_string(kMostFrames) +
                       " pictures: reduce --length or --rate, or increase --speed");
  const SceneDrawing scene(*result, page_theme(options.theme), options.across_m / options.width);
  files::Animation animation;
  animation.frame_ms = static_cast<std::uint16_t>(std::lround(1000.0 / options.rate_hz));
  for (std::size_t i = 0; i < count; ++i)
    animation.frames.push_back(to_pixels(
        frame_at(*result, scene, options, from_s + static_cast<double>(i) * step_s), 1.0));
  const path output = options.output.empty() ? options.result / "drive.png" : options.output;
  if (const auto fault = files::write_file_atomically(output, files::to_animated_png(animation)))
    return files::fail(fault->message);
  std::printf("%s\n", output.c_str());
  return 0;
}

}  // namespace

void add_animate_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("animate", "Draw a stretch of a drive as an animated PNG");
  const auto options = std::make_shared<AnimateOptions>();
  const auto number = [&](const char* name, double& value, const char* about, double low,
                          double high, const char* unit) {
    command->add_option(name, value, about)
        ->type_name(unit)
        ->check(files::number_between(low, high))
        ->capture_default_str();
  };
  command->add_option("result", options->result, "Folder that run or bench wrote")
      ->required()
      ->type_name("DIR");
  command->add_option("--output", options->output, "Picture to write [DIR/drive.png]")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from_s,
                   "Begin, in seconds of the drive; default: where the most objects move")
      ->check(files::not_negative_number())
      ->type_name("S");
  number("--length", options->length_s, "Length, in seconds of the drive", 0.1, 36'000.0, "S");
  number("--speed", options->speed, "Multiple of the recorded rate", 0.01, 1000.0, "X");
  number("--rate", options->rate_hz, "Pictures a second", 1.0, 50.0, "HZ");
  number("--width", options->width, "Pixels", 64.0, 4096.0, "N");
  number("--height", options->height, "Pixels", 64.0, 4096.0, "N");
  number("--across", options->across_m, "Metres of the ground along the width", 1.0, 10'000.0, "M");
  command->add_option("--theme", options->theme, "Colours: dark or light")
      ->type_name("dark|light")
      ->check(CLI::IsMember({"dark", "light"}))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = animate(*options); });
}

}  // namespace slammot::evaluator
