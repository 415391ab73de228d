#include "services/evaluator/result_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/files/ways_file.hpp"
#include "services/evaluator/table_file.hpp"
#include "services/evaluator/truth_files.hpp"

namespace slammot::evaluator {
namespace {

using files::Error;
using files::Result;
using std::filesystem::path;

constexpr double kLargestId = 4294967295.0;
constexpr double kFarthestAheadS = 60.0;

using TracksByStamp = std::map<std::int64_t, std::vector<ResultTrack>>;

std::optional<Error> read_tracks(const path& file, TracksByStamp& tracks) {
  std::vector<std::string_view> columns = {"timestamp", "track_id", "x",    "y",
                                           "heading",   "vx",       "vy",   "length",
                                           "width",     "motion",   "class"};
  const bool has_occluded = !columns_with_prefix(file, "occluded").empty();
  const bool has_existence = !columns_with_prefix(file, "existence").empty();
  if (has_occluded) columns.emplace_back("occluded");
  if (has_existence) columns.emplace_back("existence");
  return read_csv(file, columns, [&](auto fields) -> RowFault {
    const auto row = numbers(fields.first(9));
    if (!row) return "a field is not a number";
    const auto& v = *row;
    if (v[1] < 0.0 || v[1] > kLargestId) return "not a valid track id";
    ResultTrack track;
    track.stamp_ns = to_ns(v[0]);
    track.track_id = static_cast<std::uint32_t>(v[1]);
    track.map_from_object = {v[2], v[3], v[4]};
    track.velocity_in_map_mps = {v[5], v[6]};
    track.length_m = v[7];
    track.width_m = v[8];
    track.is_moving = fields[9] == "moving";
    track.object_class = fields[10];
    track.is_occluded = has_occluded && fields[11] == "1";
    if (has_existence) {
      const auto existence = numbers(fields.last(1));
      if (!existence) return "existence is not a number";
      track.existence = existence->front();
    }
    tracks[track.stamp_ns].push_back(std::move(track));
    return std::nullopt;
  });
}

std::optional<Error> read_track_details(const path& file, TracksByStamp& tracks) {
  const std::vector<std::string> modes = columns_with_prefix(file, "mode_");
  std::vector<std::string_view> columns = {"timestamp", "track_id", "var_x",   "cov_xy",
                                           "var_y",     "var_vx",   "cov_vxy", "var_vy"};
  const auto first_mode = static_cast<std::ptrdiff_t>(columns.size());
  columns.insert(columns.end(), modes.begin(), modes.end());
  return read_csv(file, columns, [&](auto fields) -> RowFault {
    const auto row = numbers(fields);
    if (!row) return "a field is not a number";
    const auto& v = *row;
    if (v[1] < 0.0 || v[1] > kLargestId) return "not a valid track id";
    const auto at = tracks.find(to_ns(v[0]));
    if (at == tracks.end()) return "no such scan in tracks.csv";
    for (ResultTrack& track : at->second) {
      if (track.track_id != static_cast<std::uint32_t>(v[1])) continue;
      track.position_covariance_m2 = (geometry::Matrix2() << v[2], v[3], v[3], v[4]).finished();
      track.velocity_covariance_m2ps2 = (geometry::Matrix2() << v[5], v[6], v[6], v[7]).finished();
      track.mode_probability.assign(v.begin() + first_mode, v.end());
    }
    return std::nullopt;
  });
}

std::optional<Error> read_predictions(const path& file, TracksByStamp& tracks) {
  return read_csv(
      file, {"timestamp", "track_id", "after", "x", "y", "var_x", "cov_xy", "var_y"},
      [&](auto fields) -> RowFault {
        const auto row = numbers(fields);
        if (!row) return "a field is not a number";
        const auto& v = *row;
        if (v[1] < 0.0 || v[1] > kLargestId) return "not a valid track id";
        if (v[2] < 0.0 || v[2] > kFarthestAheadS) return "not a valid horizon";
        const auto at = tracks.find(to_ns(v[0]));
        if (at == tracks.end()) return "no such scan in tracks.csv";
        for (ResultTrack& track : at->second) {
          if (track.track_id != static_cast<std::uint32_t>(v[1])) continue;
          track.predicted_in_map.push_back(
              {v[2], {v[3], v[4]}, (geometry::Matrix2() << v[5], v[6], v[6], v[7]).finished()});
        }
        return std::nullopt;
      });
}

std::optional<Error> read_online_covariance(const path& file,
                                            std::vector<metrics::UncertainStampedPose>& poses) {
  return read_csv(
      file,
      {"timestamp", "x", "y", "heading", "var_x", "cov_xy", "cov_xh", "var_y", "cov_yh", "var_h"},
      [&](auto fields) -> RowFault {
        const auto row = numbers(fields);
        if (!row) return "a field is not a number";
        const auto& v = *row;
        geometry::UncertainPose2 pose{{v[1], v[2], v[3]}, geometry::Matrix3::Zero()};
        pose.covariance << v[4], v[5], v[6], v[5], v[7], v[8], v[6], v[8], v[9];
        poses.push_back({to_ns(v[0]), pose});
        return std::nullopt;
      });
}

/// With several scanners, reads the labels of the first one, as for true hits.
std::optional<Error> read_labels(const path& file, std::vector<LabelsAt>& labels) {
  std::vector<std::string_view> columns = {"timestamp", "detection", "tracking"};
  const bool has_several_scanners = !columns_with_prefix(file, "scanner").empty();
  if (has_several_scanners) columns.emplace_back("scanner");
  std::string scanner;
  return read_csv(file, columns, [&](auto fields) -> RowFault {
    const auto stamp = numbers(fields.first(1));
    if (!stamp) return "a field is not a number";
    if (has_several_scanners && scanner.empty()) scanner = fields[3];
    if (has_several_scanners && scanner != fields[3]) return std::nullopt;
    labels.push_back({to_ns(stamp->front()), std::string(fields[1]), std::string(fields[2])});
    return std::nullopt;
  });
}

std::optional<double> yaml_number(const std::string& yaml, const std::string& key) {
  const std::size_t at = yaml.find(key + ":");
  double value = 0.0;
  if (at == std::string::npos ||
      std::sscanf(yaml.c_str() + at + key.size() + 1, " %lf", &value) != 1)
    return std::nullopt;
  return value;
}

std::string read_all(const path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Member of the report's input; 0 if it is missing.
double number_of_input(const nlohmann::json& report, const std::string& name) {
  const auto place = nlohmann::json::json_pointer("/input/" + name);
  return report.is_object() && report.contains(place) && report[place].is_number()
             ? report[place].get<double>()
             : 0.0;
}

std::vector<LostSpan> losses_of(const nlohmann::json& report, std::int64_t first_ns) {
  std::vector<LostSpan> losses;
  if (!report.is_object() || !report.contains("losses") || !report["losses"].is_array())
    return losses;
  for (const auto& loss : report["losses"]) {
    if (!loss.is_object() || !loss.contains("begin_s") || !loss["begin_s"].is_number() ||
        !loss.contains("end_s") || !loss["end_s"].is_number())
      continue;
    losses.push_back({first_ns + to_ns(loss["begin_s"].get<double>()),
                      first_ns + to_ns(loss["end_s"].get<double>())});
  }
  return losses;
}

}  // namespace

Result<files::MapImage> read_map(const path& yaml_file) {
  const std::string yaml = read_all(yaml_file);
  files::MapImage image;
  const auto resolution_m = yaml_number(yaml, "resolution");
  const std::size_t origin = yaml.find("origin:");
  if (!resolution_m || origin == std::string::npos ||
      std::sscanf(yaml.c_str() + origin, "origin: [%lf, %lf", &image.min_x_m, &image.min_y_m) != 2)
    return Error{yaml_file.string() + ": no resolution or no origin"};
  constexpr double kFarM = 1e7;
  if (!(*resolution_m >= 1e-3 && *resolution_m <= 1e3) ||
      !(std::abs(image.min_x_m) <= kFarM && std::abs(image.min_y_m) <= kFarM))
    return Error{yaml_file.string() + ": no resolution or origin of a map"};
  image.resolution_m = *resolution_m;
  const path pgm_file = path(yaml_file).replace_extension(".pgm");
  const std::string pgm = read_all(pgm_file);
  unsigned depth = 0;
  int header = 0;
  if (std::sscanf(pgm.c_str(), "P5 %u %u %u%n", &image.width, &image.height, &depth, &header) !=
          3 ||
      depth != 255)
    return Error{pgm_file.string() + ": not a binary grey picture of 8 bits"};
  const auto begin = static_cast<std::size_t>(header) + 1;  // A single blank ends the header.
  const std::size_t pixels = std::size_t{image.width} * image.height;
  if (pgm.size() < begin + pixels) return Error{pgm_file.string() + ": cut off"};
  image.pixels.assign(pgm.begin() + static_cast<std::ptrdiff_t>(begin),
                      pgm.begin() + static_cast<std::ptrdiff_t>(begin + pixels));
  return image;
}

std::optional<Error> read_small_files(const path& folder, RunResult& result) {
  result.report_json = read_all(folder / "report.json");
  const auto report = nlohmann::json::parse(result.report_json, nullptr, false);
  result.sweep_s = number_of_input(report, "sweep_s");
  result.base_from_laser = {number_of_input(report, "laser_ahead_m"),
                            number_of_input(report, "laser_left_m"),
                            number_of_input(report, "laser_heading_rad")};
  if (!result.online.empty()) result.losses = losses_of(report, result.online.front().stamp_ns);
  result.graph = read_graph(folder / "graph.g2o");
  if (std::filesystem::exists(folder / "lanes.geojson")) {
    auto ways = files::read_ways(folder / "lanes.geojson");
    if (!ways) return ways.error();
    result.ways = std::move(*ways);
  }
  for (const auto& [name, image] :
       {std::pair("map.yaml", &result.map), std::pair("moving.yaml", &result.moving)}) {
    if (!std::filesystem::exists(folder / name)) continue;
    auto map = read_map(folder / name);
    if (!map) return map.error();
    *image = std::move(*map);
  }
  return std::nullopt;
}

Result<RunResult> read_map_folder(const path& folder) {
  RunResult result;
  if (!std::filesystem::exists(folder / "map.yaml"))
    return Error{(folder / "map.yaml").string() + ": no such file"};
  if (auto fault = read_small_files(folder, result)) return *fault;
  return result;
}

Result<RunResult> read_result(const path& folder) {
  RunResult result;
  auto online = read_tum(folder / "online.tum");
  if (!online) return online.error();
  auto corrected = read_tum(folder / "trajectory.tum");
  if (!corrected) return corrected.error();
  result.online = std::move(*online);
  result.corrected = std::move(*corrected);
  TracksByStamp tracks;
  if (const auto file = plain_or_gz(folder / "tracks.csv")) {
    if (auto fault = read_tracks(*file, tracks)) return *fault;
  }
  if (const auto file = plain_or_gz(folder / "track_details.csv")) {
    if (auto fault = read_track_details(*file, tracks)) return *fault;
  }
  if (const auto file = plain_or_gz(folder / "predictions.csv")) {
    if (auto fault = read_predictions(*file, tracks)) return *fault;
  }
  for (auto& [stamp_ns, rows] : tracks) result.tracks.push_back({stamp_ns, std::move(rows)});
  if (const auto file = plain_or_gz(folder / "online_covariance.csv")) {
    if (auto fault = read_online_covariance(*file, result.uncertain)) return *fault;
  }
  if (const auto file = plain_or_gz(folder / "labels.csv")) {
    if (auto fault = read_labels(*file, result.labels)) return *fault;
  }
  if (auto fault = read_small_files(folder, result)) return *fault;
  return result;
}

}  // namespace slammot::evaluator
