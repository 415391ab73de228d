#include "services/slammot/streets_command.hpp"

#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>

#include "common/files/failure.hpp"
#include "services/evaluator/result_files.hpp"
#include "services/evaluator/truth_files.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/street_search.hpp"

namespace slammot {
namespace {

struct StreetsOptions {
  StreetOptions streets;
  std::filesystem::path trajectory;
  std::filesystem::path map;
};

int find(const StreetsOptions& options) {
  const auto job = prepare_streets(options.streets);
  if (!job) return files::fail(job.error());
  const auto read = evaluator::read_tum(options.trajectory);
  if (!read) return files::fail(read.error());
  std::optional<files::MapImage> map;
  if (!options.map.empty()) {
    auto image = evaluator::read_map(options.map);
    if (!image) return files::fail(image.error());
    map = std::move(*image);
  }
  std::vector<files::StampedPose> trajectory;
  for (const metrics::StampedPose& pose : *read) trajectory.push_back({pose.stamp_ns, pose.pose});
  std::printf("%s\n", files::to_json_text(
                          find_on_streets(**job, trajectory, std::nullopt, map ? &*map : nullptr))
                          .c_str());
  return kExitDone;
}

}  // namespace

void add_streets_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("streets", "Find a driven trajectory in a street graph");
  const auto options = std::make_shared<StreetsOptions>();
  command
      ->add_option("--trajectory", options->trajectory,
                   "Poses as TUM lines, for example a "
                   "result's trajectory.tum")
      ->required()
      ->type_name("FILE");
  command
      ->add_option("--map", options->map,
                   "Map of the same frame, in which side streets are seen: a result's map.yaml")
      ->type_name("FILE");
  add_street_options(*command, options->streets);
  command->get_option("--streets")->required();
  command->callback([options, &exit_code] { exit_code = find(*options); });
}

}  // namespace slammot
