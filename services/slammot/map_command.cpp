#include "services/slammot/map_command.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/app/service_options.hpp"
#include "common/files/atomic_file.hpp"
#include "common/files/failure.hpp"
#include "common/files/run_outputs.hpp"
#include "common/files/text.hpp"
#include "common/files/ways_file.hpp"
#include "common/traffic/map_traffic.hpp"
#include "common/traffic/submap_traffic.hpp"
#include "common/traffic/ways.hpp"
#include "services/loop_closing/map_merge.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/job.hpp"
#include "services/slammot/stored_map.hpp"

namespace slammot {
namespace {

using Clock = std::chrono::steady_clock;
using loop_closing::Merge;
using loop_closing::MergeOutcome;
using Submaps = std::vector<flow::Submap>;

/// A stored map with what moved in it.
struct MapWithTraffic {
  Submaps submaps;
  traffic::SubmapTraffic traffic;
};

struct MergeOptions {
  std::filesystem::path first;
  std::filesystem::path second;
  std::filesystem::path output;
  std::string profile;
  std::filesystem::path config;
};

/// Settings of the first map's run, if no others are given and its folder holds them.
std::filesystem::path settings_of(const MergeOptions& options) {
  if (!options.profile.empty() || !options.config.empty()) return options.config;
  const std::filesystem::path settings = options.first / kSettingsFile;
  return std::filesystem::is_regular_file(settings) ? settings : std::filesystem::path();
}

/// The result would replace a map that it is made of, or hold one map twice.
std::optional<files::Error> find_usage_fault(const MergeOptions& options) {
  const std::filesystem::path first = database_of(options.first);
  const std::filesystem::path second = database_of(options.second);
  if (first == second)
    return files::Error{options.first.string() + " and " + options.second.string() +
                        " are one map: name two"};
  const std::filesystem::path output = database_of(options.output);
  if (output == first || output == second)
    return files::Error{"--output " + options.output.string() +
                        ": holds a map that is merged: name another folder"};
  return std::nullopt;
}

files::Result<MapWithTraffic> read_map(const std::filesystem::path& path, const Profile& profile) {
  auto submaps = read_stored_map(path, profile.localization.map.cell_size_m);
  if (!submaps) return submaps.error();
  if (submaps->empty()) return files::Error{path.string() + ": contains no submap"};
  auto traffic = read_stored_traffic(path);
  if (!traffic) return traffic.error();
  std::printf("map:      %zu submaps of %s\n", submaps->size(), path.c_str());
  return MapWithTraffic{std::move(*submaps), std::move(*traffic)};
}

/// A drive that both maps hold would be in the joint map twice.
std::optional<files::Error> find_common_part(const MergeOptions& options,
                                             const MapWithTraffic& first,
                                             const MapWithTraffic& second) {
  const std::size_t common = submaps_in_common(first.submaps, second.submaps);
  if (common == 0) return std::nullopt;
  return files::Error{
      files::text("%zu of the %zu submaps of %s are in %s, too: they are merged "
                  "already, or one map is a copy or continuation of the other",
                  common, second.submaps.size(), options.second.c_str(), options.first.c_str())};
}

std::string describe(const Merge& merge) {
  char text[200];
  std::snprintf(text, sizeof text,
                "%d closures at %d submaps of the second map; %d of %d overlapping submaps "
                "contradict the first map; %.0f %% of their walls agree",
                merge.closures, merge.places, merge.contradicting, merge.overlapping,
                100.0 * merge.agreed_share);
  switch (merge.outcome) {
    case MergeOutcome::kJoined: return std::string("joined: ") + text;
    case MergeOutcome::kNoCommonPlace: return "no place of the second map is certain in the first";
    case MergeOutcome::kTooFewPlaces:
      return std::string("too few submaps confirm a place: ") + text;
    case MergeOutcome::kContradicted: return std::string("the walls disagree: ") + text;
  }
  return {};
}

/// What moved in both maps, by the numbers of the joint one.
traffic::SubmapTraffic joint_traffic(const MapWithTraffic& first, const MapWithTraffic& second) {
  traffic::SubmapTraffic joint = traffic::renumbered(first.traffic, first.submaps, {0});
  joint.merge(traffic::renumbered(second.traffic, second.submaps,
                                  {static_cast<std::uint32_t>(first.submaps.size())}));
  return joint;
}

/// Lanes and walkways of both maps, where the correction places their submaps.
std::string lanes_of(const traffic::SubmapTraffic& traffic,
                     const flow::GraphCorrection& correction) {
  traffic::MapTraffic in_map;
  for (const auto& [submap_id, streams] : traffic) in_map.add(submap_id, streams);
  in_map.place(correction);
  return files::to_geojson(traffic::find_ways(traffic::traffic_in_map(in_map.placed())));
}

files::RunRecord record_of(const Merge& merge) {
  files::RunRecord record;
  for (const flow::Submap& submap : merge.submaps) record.add(submap);
  record.add(merge.correction);
  for (const flow::Constraint& constraint : merge.constraints) record.add(constraint);
  return record;
}

files::RunReport report_of(const Merge& merge, const MergeOptions& options, double wall_s) {
  files::RunReport report;
  report.command = "map merge";
  report.version = SLAMMOT_VERSION;
  report.is_of_drive = false;
  report.input = options.first.filename().string() + " + " + options.second.filename().string();
  report.counters = {{"loop_closing", named(merge.counters)},
                     {"merge",
                      {{"closures", static_cast<std::uint64_t>(merge.closures)},
                       {"places", static_cast<std::uint64_t>(merge.places)},
                       {"overlapping", static_cast<std::uint64_t>(merge.overlapping)},
                       {"contradicting", static_cast<std::uint64_t>(merge.contradicting)}}}};
  report.measured = {{}, wall_s, 0.0, peak_memory_mb()};
  return report;
}

std::optional<files::Error> write(const Merge& merge, const traffic::SubmapTraffic& traffic,
                                  const MergeOptions& options, const Profile& profile,
                                  double wall_s) {
  if (auto fault = files::prepare_output_folder(options.output)) return fault;
  if (auto fault =
          write_stored_map(options.output, merge.submaps, app::ServiceOptions().vehicle_id))
    return fault;
  if (auto fault = write_stored_traffic(options.output, traffic)) return fault;
  if (auto fault = write_settings(profile, options.output)) return fault;
  if (auto fault = files::write_file_atomically(options.output / "lanes.geojson",
                                                lanes_of(traffic, merge.correction)))
    return fault;
  return files::write_map_outputs(options.output, record_of(merge),
                                  report_of(merge, options, wall_s));
}

int merge_maps(const MergeOptions& options) {
  if (const auto fault = find_usage_fault(options)) return files::refuse(fault->message);
  const auto start = Clock::now();
  Profile profile;
  if (auto fault = load_settings(options.profile, settings_of(options), profile))
    return files::fail(files::Error{std::move(*fault)});
  const auto first = read_map(options.first, profile);
  if (!first) return files::fail(first.error());
  const auto second = read_map(options.second, profile);
  if (!second) return files::fail(second.error());
  std::fflush(stdout);
  if (const auto fault = find_common_part(options, *first, *second))
    return files::refuse(fault->message);
  const Merge merge =
      loop_closing::merge_maps(profile.loop_closing, first->submaps, second->submaps);
  if (merge.outcome != MergeOutcome::kJoined) {
    std::fprintf(stderr, "slammot: not merged: %s; nothing was written\n", describe(merge).c_str());
    return kExitNotJoined;
  }
  const double wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  if (const auto fault = write(merge, joint_traffic(*first, *second), options, profile, wall_s))
    return files::fail(*fault);
  const geometry::Pose2& origin = merge.correction.submaps[first->submaps.size()].map_from_submap;
  std::printf("map:      %s\n", describe(merge).c_str());
  std::printf("map:      the second map begins at x %.2f m, y %.2f m, heading %.4f rad\n",
              origin.x_m, origin.y_m, origin.heading_rad);
  std::printf("results are in %s\n", options.output.c_str());
  return kExitDone;
}

void add_merge_command(CLI::App& map, int& exit_code) {
  CLI::App* const command = map.add_subcommand(
      "merge", "Join two stored maps with unknown relative start, or refuse to (exit code 4)");
  const auto options = std::make_shared<MergeOptions>();
  constexpr const char* kMap =
      "a folder written with run --store-map or map merge, map_store's folder or its file";
  command->add_option("first", options->first, std::string("Map that defines the frame: ") + kMap)
      ->required()
      ->type_name("DIR|FILE");
  command->add_option("second", options->second, "Map that is moved: the same")
      ->required()
      ->type_name("DIR|FILE");
  command->add_option("--output", options->output, "Folder for the joint map; created if missing")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--profile", options->profile,
                   "Profile of both drives; default: the settings in the first map's folder")
      ->type_name("NAME");
  command->add_option("--config", options->config, "Settings that override the profile's")
      ->type_name("FILE");
  command->callback([options, &exit_code] { exit_code = merge_maps(*options); });
}

}  // namespace

void add_map_command(CLI::App& app, int& exit_code) {
  CLI::App* const command = app.add_subcommand("map", "Work on stored maps: merge two into one");
  command->require_subcommand(1);
  add_merge_command(*command, exit_code);
}

}  // namespace slammot
