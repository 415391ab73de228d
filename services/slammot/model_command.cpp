#include "services/slammot/model_command.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/city_model/accuracy.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/ply_file.hpp"
#include "common/files/text.hpp"
#include "common/simulation/surface.hpp"
#include "services/evaluator/model_truth.hpp"
#include "services/evaluator/truth_files.hpp"
#include "services/ingest/topic_arguments.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job_text.hpp"
#include "services/slammot/model_log.hpp"

namespace slammot {
namespace {

using files::Error;
using std::filesystem::path;

struct ModelOptions {
  path result;
  ModelInput input;
  path output;  ///< Of the facades; empty: model.ply in the result.
  path points;  ///< Empty: not written.
  path truth;   ///< Prefix; empty: not judged.
};

/// From blue at the road to yellow at a tall roof.
files::Rgb colour_at(double height_m) {
  constexpr double kTall_m = 15.0;
  const double share = std::clamp(height_m / kTall_m, 0.0, 1.0);
  const auto mix = [&](double low, double high) {
    return static_cast<std::uint8_t>(std::lround(low + share * (high - low)));
  };
  return {mix(60.0, 250.0), mix(90.0, 210.0), mix(170.0, 90.0)};
}

files::PlyVertex vertex(const geometry::Vector2& at_m, double height_m) {
  return {
      {static_cast<float>(at_m.x()), static_cast<float>(at_m.y()), static_cast<float>(height_m)},
      colour_at(height_m)};
}

files::PlyModel facades_of(const city_model::CityModel& model) {
  files::PlyModel ply;
  for (const city_model::Facade& facade : model.facades) {
    const auto first = static_cast<std::uint32_t>(ply.vertices.size());
    ply.vertices.push_back(vertex(facade.from_m, facade.bottom_m));
    ply.vertices.push_back(vertex(facade.to_m, facade.bottom_m));
    ply.vertices.push_back(vertex(facade.to_m, facade.top_m));
    ply.vertices.push_back(vertex(facade.from_m, facade.top_m));
    ply.quads.push_back({first, first + 1, first + 2, first + 3});
  }
  return ply;
}

files::PlyModel points_of(const city_model::CityModel& model) {
  files::PlyModel ply;
  for (const city_model::PlacedEcho& point : model.points) {
    const Eigen::Vector3f& at_m = point.position_in_map_m;
    ply.vertices.push_back(vertex({static_cast<double>(at_m.x()), static_cast<double>(at_m.y())},
                                  static_cast<double>(at_m.z())));
  }
  return ply;
}

std::int64_t microseconds(std::int64_t stamp_ns) { return (stamp_ns + 500) / 1000; }

/// The hits of the true scanner with the same stamps and beams; null if there is none.
const std::map<std::int64_t, evaluator::HitsOfMovers>* hits_of(
    const std::string& scanner, const ModelOfLog& built, const evaluator::HitsByScanner& truth) {
  for (const auto& scanner_and_hits : truth) {
    const auto& by_stamp = scanner_and_hits.second;
    const bool fits = std::ranges::all_of(built.scans, [&](const ModelledScan& scan) {
      if (scan.scanner != scanner) return true;
      const auto hits = by_stamp.find(microseconds(scan.stamp_ns));
      return hits != by_stamp.end() && hits->second.size() == scan.beams;
    });
    if (fits) return &by_stamp;
  }
  return nullptr;
}

std::vector<std::uint8_t> movers_among(const ModelOfLog& built,
                                       const evaluator::HitsByScanner& truth) {
  std::map<std::string, const std::map<std::int64_t, evaluator::HitsOfMovers>*> of_scanner;
  for (const files::ScannerPlan& scanner : built.scanners)
    of_scanner[scanner.name] = hits_of(scanner.name, built, truth);
  std::vector<std::uint8_t> is_of_mover;
  for (const city_model::PlacedEcho& point : built.model.points) {
    const ModelledScan& scan = built.scans[point.scan];
    const auto* hits = of_scanner.at(scan.scanner);
    if (hits == nullptr) return {};
    is_of_mover.push_back(hits->at(microseconds(scan.stamp_ns))[point.beam]);
  }
  return is_of_mover;
}

files::Result<city_model::ModelAccuracy> judge(const evaluator::RunResult& result,
                                               const ModelOfLog& built, const path& prefix) {
  constexpr std::int64_t kSame_ns = 10'000'000;
  const auto trajectory = evaluator::read_tum(prefix.string() + ".tum");
  if (!trajectory) return trajectory.error();
  const auto walls = evaluator::read_classed_walls(prefix);
  if (!walls) return walls.error();
  const auto hits = evaluator::read_hits_of_movers(prefix);
  if (!hits) return hits.error();
  const auto pairs = metrics::associate(*trajectory, result.corrected, kSame_ns);
  if (pairs.empty()) return Error{prefix.string() + ".tum: no common time with the result"};
  city_model::ModelTruth truth{metrics::align_rigidly(pairs), {}, movers_among(built, *hits)};
  for (const evaluator::ClassedWall& wall : *walls) {
    const auto material = static_cast<simulation::Material>(wall.wall_class);
    truth.surfaces.push_back({wall.from_m, wall.to_m, simulation::usual_height_m(material),
                              material == simulation::Material::wall});
  }
  return city_model::judge(built.model, truth);
}

nlohmann::ordered_json json_of(const city_model::CityModel& model) {
  const city_model::ModelCounts& counts = model.counts;
  return {{"scans", counts.scans},         {"scans_without_pose", counts.scans_without_pose},
          {"echoes", counts.echoes},       {"of_road", counts.of_road},
          {"of_movers", counts.of_movers}, {"in_free_space", counts.in_free_space},
          {"points", model.points.size()}, {"facades", model.facades.size()}};
}

nlohmann::ordered_json json_of(const city_model::ModelAccuracy& accuracy) {
  return {{"point_distance_median_m", accuracy.point_distance_m.median},
          {"point_distance_p95_m", accuracy.point_distance_m.p95},
          {"astray_share", accuracy.astray_share},
          {"wall_facades", accuracy.wall_top_error_m.count},
          {"wall_top_error_median_m", accuracy.wall_top_error_m.median},
          {"wall_top_error_p95_m", accuracy.wall_top_error_m.p95},
          {"wall_top_bias_m", accuracy.wall_top_bias_m},
          {"residue_share", accuracy.residue_share}};
}

void print(const city_model::CityModel& model) {
  const city_model::ModelCounts& counts = model.counts;
  const auto count = [](std::uint64_t value) { return static_cast<unsigned long long>(value); };
  std::printf(
      "%llu vertical scans, %llu echoes: %llu of the road, %llu of moving objects, %llu in "
      "space that was free\n",
      count(counts.scans), count(counts.echoes), count(counts.of_road), count(counts.of_movers),
      count(counts.in_free_space));
  std::printf("%zu points, %zu facades\n", model.points.size(), model.facades.size());
  constexpr double kUsualInFreeSpace = 0.01;
  const double share = static_cast<double>(counts.in_free_space) /
                       static_cast<double>(std::max<std::uint64_t>(1, counts.echoes));
  if (share > kUsualInFreeSpace)
    std::printf(
        "doubtful: %.1f %% of the echoes are in space that was free: another drive's log, or "
        "a wrong mounting?\n",
        100.0 * share);
}

void print(const city_model::ModelAccuracy& accuracy) {
  std::printf("distance to true surfaces: median %.3f m, 95 %% %.3f m; %.2f %% beyond 1 m\n",
              accuracy.point_distance_m.median, accuracy.point_distance_m.p95,
              100.0 * accuracy.astray_share);
  std::printf("top of walls (%zu facades): error median %.2f m, 95 %% %.2f m, bias %.2f m\n",
              accuracy.wall_top_error_m.count, accuracy.wall_top_error_m.median,
              accuracy.wall_top_error_m.p95, accuracy.wall_top_bias_m);
  std::printf("echoes of moving objects left in the model: %.3f %%\n",
              100.0 * accuracy.residue_share);
}

std::optional<Error> write_files(const ModelOptions& options, const ModelOfLog& built) {
  if (auto fault = files::write_file_atomically(options.output, to_ply(facades_of(built.model))))
    return fault;
  if (options.points.empty()) return std::nullopt;
  return files::write_file_atomically(options.points, to_ply(points_of(built.model)));
}

std::optional<Error> complete(ModelOptions& options) {
  if (options.output.empty()) options.output = options.result / "model.ply";
  if (options.input.log.empty()) options.input.log = options.result / "truth.log.gz";
  std::error_code ignored;
  if (std::filesystem::exists(options.input.log, ignored)) return std::nullopt;
  return Error{options.input.log.string() +
               ": no such log; --input FILE names the one that the result was made of"};
}

int make_model(ModelOptions options) {
  const auto result = evaluator::read_result(options.result);
  if (!result) return files::fail(result.error());
  if (const auto fault = complete(options)) return files::fail(*fault);
  const auto built = model_of(*result, options.input);
  if (!built) return files::fail(built.error());
  print(built->model);
  nlohmann::ordered_json figures = json_of(built->model);
  if (!options.truth.empty()) {
    const auto accuracy = judge(*result, *built, options.truth);
    if (!accuracy) return files::fail(accuracy.error());
    print(*accuracy);
    figures["accuracy"] = json_of(*accuracy);
  }
  if (const auto fault = write_files(options, *built)) return files::fail(*fault);
  path json = options.output;
  json.replace_extension(".json");
  if (const auto fault = files::write_file_atomically(json, figures.dump(2) + "\n"))
    return files::fail(*fault);
  std::printf("%s\n", options.output.c_str());
  return report_damage(options.input.log, built->faults);
}

}  // namespace

void add_model_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand(
      "model", "Make a 2.5-D model of facades from a vertical scanner and a result");
  const auto options = std::make_shared<ModelOptions>();
  command->add_option("--result", options->result, "Folder that run or bench wrote")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--input", options->input.log,
                   "The log that the result was made of [DIR/truth.log.gz, of a scenario]")
      ->type_name("FILE");
  command
      ->add_option("--scanner", options->input.scanners,
                   "Vertical scanners to use; default: all that the log states")
      ->type_name("NAME[,NAME]")
      ->delimiter(',');
  ingest::add_vertical_option(*command, options->input.topics);
  command->add_option("--output", options->output, "Facades as PLY [DIR/model.ply]")
      ->type_name("FILE");
  command->add_option("--points", options->points, "Also write the points, as PLY")
      ->type_name("FILE");
  command
      ->add_option("--truth", options->truth,
                   "Prefix of a simulator's true files: judges the model")
      ->type_name("PREFIX");
  command->callback([options, &exit_code] { exit_code = make_model(*options); });
}

}  // namespace slammot
