#include "services/slammot/street_search.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>

#include <CLI/CLI.hpp>

#include "common/files/finite_number.hpp"
#include "common/files/number_option.hpp"
#include "common/files/street_file.hpp"
#include "common/files/text.hpp"

namespace slammot {
namespace {

using files::Error;
using geometry::Geodetic;

std::optional<Geodetic> parse_place(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto latitude_deg = files::finite_number(text.substr(0, comma));
  const auto longitude_deg = files::finite_number(text.substr(comma + 1));
  if (!latitude_deg || !longitude_deg || std::abs(*latitude_deg) > 89.0 ||
      std::abs(*longitude_deg) > 180.0)
    return std::nullopt;
  return Geodetic{*latitude_deg, *longitude_deg};
}

/// True if no way that is compared reaches a street from there.
bool is_off_the_streets(const streets::StreetGraph& graph, const streets::StartArea& start) {
  return graph.distance_m(start.centre_m) > start.radius_m + kMostStreetWay_m;
}

double km_to_streets(const streets::StreetGraph& graph, const streets::StartArea& start) {
  return 1e-3 * graph.distance_m(start.centre_m);
}

/// Around the first pose, as far as the georeference is uncertain; none without a place near the
/// streets.
std::optional<streets::StartArea> place_by_gnss(const StreetJob& job, const geometry::Pose2& first,
                                                const flow::Georeference& georeference) {
  constexpr double kLeast_m = 30.0;
  constexpr double kSigmas = 3.0;
  if (!georeference.has_position) return std::nullopt;
  const geometry::Vector2 origin_m = geometry::east_north_m(job.graph.origin, georeference.origin);
  const geometry::Pose2 streets_from_map{origin_m.x(), origin_m.y(), georeference.x_from_east_rad};
  const streets::StartArea start{.centre_m = streets_from_map * first.translation_m(),
                                 .radius_m = kLeast_m + kSigmas * georeference.position_sigma_m};
  if (!is_off_the_streets(job.graph, start)) return start;
  std::fprintf(stderr,
               "slammot: GNSS is not used to find the drive on the streets: its place lies %.1f km "
               "from the nearest street\n",
               km_to_streets(job.graph, start));
  return std::nullopt;
}

std::optional<streets::StartArea> start_of(const StreetJob& job, const geometry::Pose2& first,
                                           const std::optional<flow::Georeference>& georeference) {
  constexpr double kLeast_rad = 0.2;
  constexpr double kSigmas = 3.0;
  std::optional<streets::StartArea> start = job.start;
  if (!start && georeference) start = place_by_gnss(job, first, *georeference);
  const bool is_measured = georeference && georeference->has_direction;
  if (!job.x_from_east_rad && !is_measured) return start;
  if (!start) start = streets::StartArea{.radius_m = streets::kAnywhere_m};
  start->x_from_east_rad = job.x_from_east_rad;
  if (start->x_from_east_rad) return start;
  start->x_from_east_rad = georeference->x_from_east_rad;
  start->direction_within_rad = kLeast_rad + kSigmas * georeference->direction_sigma_rad;
  return start;
}

streets::SeenSpace seen_in(const files::MapImage& map) {
  streets::SeenSpace seen{{map.min_x_m, map.min_y_m}, map.resolution_m, map.width, map.height, {}};
  seen.cells.reserve(map.pixels.size());
  for (std::size_t row = 0; row < map.height; ++row) {
    for (std::size_t column = 0; column < map.width; ++column) {
      const std::uint8_t pixel = map.pixels[(map.height - 1 - row) * map.width + column];
      seen.cells.push_back(pixel == files::kOccupiedPixel ? streets::Seen::kOccupied
                           : pixel == files::kFreePixel   ? streets::Seen::kFree
                                                          : streets::Seen::kUnknown);
    }
  }
  return seen;
}

}  // namespace

void add_street_options(CLI::App& command, StreetOptions& options) {
  command
      .add_option("--streets", options.file,
                  "Street graph to find the drive in: OpenStreetMap extract (XML) or GeoJSON")
      ->type_name("FILE");
  command
      .add_option("--near", options.near,
                  "Where the drive begins, for --streets; default: by GNSS, or anywhere")
      ->type_name("LATITUDE,LONGITUDE");
  command.add_option("--near-within", options.within_m, "Error of --near [m]")
      ->check(files::number_between(1.0, 1e5))
      ->capture_default_str();
  command
      .add_option(
          "--x-from-east", options.x_from_east_rad,
          "Direction of the map's x axis from east, counter-clockwise; default: by compass or "
          "GNSS of the drive, or any")
      ->check(files::number_between(-2.0 * std::numbers::pi, 2.0 * std::numbers::pi))
      ->type_name("RAD");
}

files::Result<std::optional<StreetJob>> prepare_streets(const StreetOptions& options) {
  if (options.file.empty()) {
    if (!options.near.empty()) return Error{"--near belongs to --streets"};
    if (options.x_from_east_rad) return Error{"--x-from-east belongs to --streets"};
    return std::optional<StreetJob>();
  }
  auto graph = files::read_streets(options.file);
  if (!graph) return graph.error();
  StreetJob job{std::move(*graph), std::nullopt, options.x_from_east_rad};
  if (!options.near.empty()) {
    const auto place = parse_place(options.near);
    if (!place) return Error{"--near " + options.near + ": not a latitude and a longitude"};
    job.start = {.centre_m = geometry::east_north_m(job.graph.origin, *place),
                 .radius_m = options.within_m};
    if (is_off_the_streets(job.graph, *job.start))
      return Error{files::text(
          "--near %s lies %.1f km from the nearest street of %s; LATITUDE,LONGITUDE?",
          options.near.c_str(), km_to_streets(job.graph, *job.start), options.file.c_str())};
  }
  return std::optional(std::move(job));
}

files::StreetFindings find_on_streets(const StreetJob& job,
                                      const std::vector<files::StampedPose>& trajectory,
                                      const std::optional<flow::Georeference>& georeference,
                                      const files::MapImage* map) {
  if (trajectory.empty()) return {};
  std::vector<geometry::Pose2> way;
  way.reserve(trajectory.size());
  for (const files::StampedPose& pose : trajectory) way.push_back(pose.map_from_base);
  return files::findings_of(
      streets::search_along(job.graph, way, start_of(job, way.front(), georeference),
                            kMostStreetWay_m, {},
                            map != nullptr ? seen_in(*map) : streets::SeenSpace()),
      job.graph.origin);
}

files::MapImage map_of(const files::RunRecord& record) {
  std::vector<files::PlacedSubmap> placed;
  for (const auto& [id, submap] : record.submaps())
    placed.push_back({&submap, record.map_from_submap(submap)});
  return files::draw_map(placed).stationary;
}

}  // namespace slammot
