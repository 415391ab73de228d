#include "services/evaluator/drive_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "services/evaluator/doubts.hpp"
#include "services/evaluator/figures.hpp"
#include "services/evaluator/stamps.hpp"
#include "services/evaluator/table_file.hpp"
#include "services/evaluator/way_drawing.hpp"

namespace slammot::evaluator {
namespace {

using Json = nlohmann::ordered_json;
using geometry::Pose2;

constexpr double kShortestStepS = 0.1;
constexpr std::size_t kMostRows = 130'000;  // of 39 bytes
constexpr std::size_t kMostFrames = 20'000;
constexpr std::array<const char*, 5> kClasses = {"unknown", "pedestrian", "bicycle", "car",
                                                 "truck_or_bus"};

template <typename Number>
constexpr const char* name_of_type() {
  if constexpr (std::is_same_v<Number, float>) return "f32";
  if constexpr (std::is_same_v<Number, std::uint8_t>) return "u8";
  if constexpr (std::is_same_v<Number, std::int8_t>) return "i8";
  if constexpr (std::is_same_v<Number, std::uint16_t>) return "u16";
  if constexpr (std::is_same_v<Number, std::int16_t>) return "i16";
  if constexpr (std::is_same_v<Number, std::uint32_t>) return "u32";
}

/// Nearest integer within the range of the type; 0 for NaN.
template <typename Integer>
Integer packed(double value) {
  if (std::isnan(value)) return 0;
  return static_cast<Integer>(
      std::lround(std::clamp(value, static_cast<double>(std::numeric_limits<Integer>::min()),
                             static_cast<double>(std::numeric_limits<Integer>::max()))));
}

class Columns {
 public:
  template <typename Number>
  void add(const char* name, const std::vector<Number>& values) {
    names_.push_back({name, name_of_type<Number>(), bytes_.size(), values.size()});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
  }
  const Json& names() const { return names_; }
  const std::string& bytes() const { return bytes_; }

 private:
  Json names_ = Json::array();
  std::string bytes_;
};

struct Frames {
  std::vector<float> time, x, y, heading, var_x, cov_xy, var_y;
  std::vector<std::uint32_t> first_row;
};

struct Rows {
  std::vector<std::uint32_t> track;
  std::vector<float> x, y;
  std::vector<std::int16_t> heading, vx, vy;
  std::vector<std::uint8_t> length, width, flags;
  std::vector<std::uint16_t> existence, sigma_x, sigma_y;
  std::vector<std::int8_t> correlation;
  std::array<std::vector<std::uint8_t>, 3> modes;
};

std::uint8_t flags_of(const ResultTrack& track) {
  const auto known = std::ranges::find(kClasses, track.object_class);
  const auto index = known == kClasses.end() ? 0 : known - kClasses.begin();
  return static_cast<std::uint8_t>(index + (track.is_moving ? 8 : 0) +
                                   (track.is_occluded ? 16 : 0));
}

void add_covariance(const geometry::Matrix2& P, Rows& rows) {
  const double sigma_x_m = std::sqrt(std::max(0.0, P(0, 0)));
  const double sigma_y_m = std::sqrt(std::max(0.0, P(1, 1)));
  rows.sigma_x.push_back(packed<std::uint16_t>(sigma_x_m * 1e3));
  rows.sigma_y.push_back(packed<std::uint16_t>(sigma_y_m * 1e3));
  rows.correlation.push_back(
      packed<std::int8_t>(127.0 * P(0, 1) / std::max(1e-12, sigma_x_m * sigma_y_m)));
}

void add_track(const ResultTrack& track, const Pose2& corrected_from_online, Rows& rows) {
  const Pose2 pose = corrected_from_online * track.map_from_object;
  const geometry::Matrix2 turn = geometry::rotation(corrected_from_online.heading_rad);
  const geometry::Vector2 velocity_mps = turn * track.velocity_in_map_mps;
  rows.track.push_back(track.track_id);
  rows.x.push_back(static_cast<float>(pose.x_m));
  rows.y.push_back(static_cast<float>(pose.y_m));
  rows.heading.push_back(
      packed<std::int16_t>(std::remainder(pose.heading_rad, 2.0 * std::numbers::pi) * 1e4));
  rows.vx.push_back(packed<std::int16_t>(velocity_mps.x() * 100.0));
  rows.vy.push_back(packed<std::int16_t>(velocity_mps.y() * 100.0));
  rows.length.push_back(packed<std::uint8_t>(track.length_m * 10.0));
  rows.width.push_back(packed<std::uint8_t>(track.width_m * 10.0));
  rows.existence.push_back(packed<std::uint16_t>(track.existence * 65535.0));
  rows.flags.push_back(flags_of(track));
  const geometry::Matrix2 P =
      track.position_covariance_m2.value_or(geometry::Matrix2(geometry::Matrix2::Zero()));
  add_covariance(turn * P * turn.transpose(), rows);
  for (std::size_t mode = 0; mode < rows.modes.size(); ++mode)
    rows.modes[mode].push_back(packed<std::uint8_t>(
        mode < track.mode_probability.size() ? 255.0 * track.mode_probability[mode] : 0.0));
}

/// Covariance of the position in map: that in odom, turned to the corrected heading.
geometry::Matrix2 covariance_in_map(const RunResult& result, const metrics::StampedPose& pose) {
  const auto* uncertain = at_stamp(result.uncertain, pose.stamp_ns, kSameStampNs);
  if (uncertain == nullptr) return geometry::Matrix2::Zero();
  const geometry::Matrix2 turn =
      geometry::rotation(pose.pose.heading_rad - uncertain->odom_from_base.pose.heading_rad);
  return turn * uncertain->odom_from_base.covariance.topLeftCorner<2, 2>() * turn.transpose();
}

void add_frame(const RunResult& result, const metrics::StampedPose& pose, Frames& frames,
               Rows& rows) {
  frames.time.push_back(static_cast<float>(
      static_cast<double>(pose.stamp_ns - result.corrected.front().stamp_ns) * 1e-9));
  frames.x.push_back(static_cast<float>(pose.pose.x_m));
  frames.y.push_back(static_cast<float>(pose.pose.y_m));
  frames.heading.push_back(static_cast<float>(pose.pose.heading_rad));
  const geometry::Matrix2 P = covariance_in_map(result, pose);
  frames.var_x.push_back(static_cast<float>(P(0, 0)));
  frames.cov_xy.push_back(static_cast<float>(P(0, 1)));
  frames.var_y.push_back(static_cast<float>(P(1, 1)));
  frames.first_row.push_back(static_cast<std::uint32_t>(rows.track.size()));
  const auto* tracks = at_stamp(result.tracks, pose.stamp_ns, kSameStampNs);
  if (tracks == nullptr) return;
  const Pose2 corrected_from_online =
      pose.pose * geometry::inverse(pose_near(result.online, pose.stamp_ns));
  for (const ResultTrack& track : tracks->tracks) add_track(track, corrected_from_online, rows);
}

std::size_t rows_of(const RunResult& result) {
  if (result.track_rows > 0) return result.track_rows;
  std::size_t rows = 0;
  for (const TracksAt& at : result.tracks) rows += at.tracks.size();
  return rows;
}

Json graph_json(const ResultGraph& graph) {
  Json json = {{"submaps", Json::array()}, {"constraints", Json::array()}};
  for (const auto& [id, pose] : graph.map_from_submap)
    json["submaps"].push_back({{"id", id}, {"pose", {pose.x_m, pose.y_m, pose.heading_rad}}});
  for (const GraphEdge& edge : graph.edges)
    json["constraints"].push_back({{"from", edge.from},
                                   {"to", edge.to},
                                   {"loop", edge.is_loop},
                                   {"state", edge.is_loop ? edge.state : "accepted"}});
  return json;
}

/// Points in whole decimetres.
Json lanes_json(const std::vector<traffic::Way>& ways) {
  Json json = Json::array();
  for (const traffic::Way& way : ways) {
    Json points = Json::array();
    for (const geometry::Vector2& point_m : way.points_in_map_m)
      for (const double value_m : {point_m.x(), point_m.y()})
        points.push_back(std::round(10.0 * value_m) / 10.0);
    json.push_back({{"color", colour_of(way.mover)},
                    {"directed", traffic::is_directed(way.mover)},
                    {"width", std::round(10.0 * way.width_m) / 10.0},
                    {"confidence", std::round(100.0 * way.confidence) / 100.0},
                    {"points", std::move(points)}});
  }
  return json;
}

Json doubts_json(const RunResult& result, const std::vector<float>& times_s) {
  Json json = Json::array();
  for (const Doubt& doubt : find_doubts(result)) {
    const auto seconds = [&](std::int64_t stamp_ns) {
      return static_cast<double>(stamp_ns - result.corrected.front().stamp_ns) * 1e-9;
    };
    const auto frame = [&](std::int64_t stamp_ns) {
      const auto at =
          std::lower_bound(times_s.begin(), times_s.end(), static_cast<float>(seconds(stamp_ns)));
      return std::min<std::ptrdiff_t>(at - times_s.begin(),
                                      static_cast<std::ptrdiff_t>(times_s.size()) - 1);
    };
    json.push_back({{"begin", seconds(doubt.begin_ns)},
                    {"end", seconds(doubt.end_ns)},
                    {"frames", {frame(doubt.begin_ns), frame(doubt.end_ns)}}});
  }
  return json;
}

void add_columns(const Frames& frames, const Rows& rows, Columns& columns) {
  columns.add("time", frames.time);
  columns.add("x", frames.x);
  columns.add("y", frames.y);
  columns.add("heading", frames.heading);
  columns.add("var_x", frames.var_x);
  columns.add("cov_xy", frames.cov_xy);
  columns.add("var_y", frames.var_y);
  columns.add("first_row", frames.first_row);
  columns.add("track", rows.track);
  columns.add("track_x", rows.x);
  columns.add("track_y", rows.y);
  columns.add("track_heading", rows.heading);
  columns.add("vx", rows.vx);
  columns.add("vy", rows.vy);
  columns.add("length", rows.length);
  columns.add("width", rows.width);
  columns.add("existence", rows.existence);
  columns.add("sigma_x", rows.sigma_x);
  columns.add("sigma_y", rows.sigma_y);
  columns.add("correlation", rows.correlation);
  columns.add("flags", rows.flags);
  for (std::size_t mode = 0; mode < rows.modes.size(); ++mode)
    columns.add(("mode_" + std::to_string(mode)).c_str(), rows.modes[mode]);
}

/// JSON that may stand within a page: no "<" that could begin a tag.
std::string without_tags(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char letter : json) {
    if (letter == '<') safe += "\\u003c";
    else safe += letter;
  }
  return safe;
}

}  // namespace

std::vector<std::size_t> shown_scans(const metrics::Trajectory& trajectory, std::size_t rows) {
  std::vector<std::size_t> scans;
  if (trajectory.empty()) return scans;
  const double duration_s =
      static_cast<double>(trajectory.back().stamp_ns - trajectory.front().stamp_ns) * 1e-9;
  const double most =
      std::min(static_cast<double>(kMostFrames),
               static_cast<double>(kMostRows) * static_cast<double>(trajectory.size()) /
                   static_cast<double>(std::max<std::size_t>(1, rows)));
  // A little less than a multiple of the scan period, so that rounding skips no scan.
  const std::int64_t step_ns = to_ns(0.95 * std::max(kShortestStepS, duration_s / most));
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (scans.empty() || trajectory[i].stamp_ns - trajectory[scans.back()].stamp_ns >= step_ns)
      scans.push_back(i);
  }
  return scans;
}

DriveData encode_drive(const RunResult& result, const ReportPicture* picture) {
  Frames frames;
  Rows rows;
  for (const std::size_t scan : shown_scans(result.corrected, rows_of(result)))
    add_frame(result, result.corrected[scan], frames, rows);
  frames.first_row.push_back(static_cast<std::uint32_t>(rows.track.size()));
  Columns columns;
  add_columns(frames, rows, columns);
  Json header = {{"start_s", static_cast<double>(result.corrected.front().stamp_ns) * 1e-9},
                 {"columns", columns.names()},
                 {"map", nullptr},
                 {"graph", graph_json(result.graph)},
                 {"lanes", lanes_json(result.ways.value_or(std::vector<traffic::Way>{}))},
                 {"doubts", doubts_json(result, frames.time)}};
  if (picture != nullptr)
    header["map"] = {{"min", {picture->min_x_m, picture->min_y_m}},
                     {"size", {picture->width_m, picture->height_m}}};
  return {without_tags(header.dump(-1, ' ', true, Json::error_handler_t::replace)),
          columns.bytes()};
}

}  // namespace slammot::evaluator
