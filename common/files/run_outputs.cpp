#include "common/files/run_outputs.hpp"

#include <algorithm>
#include <cmath>
#include <future>
#include <string_view>

#include <Eigen/Cholesky>

#include "common/files/atomic_file.hpp"
#include "common/files/decimal.hpp"
#include "common/files/map_image.hpp"
#include "common/files/record_traffic.hpp"

namespace slammot::files {
namespace {

const char* name_of(flow::Motion motion) {
  return motion == flow::Motion::kMoving ? "moving" : "stopped";
}

geometry::Matrix3 information_at_end(const geometry::UncertainPose2& from_to) {
  geometry::Matrix3 turn = geometry::Matrix3::Identity();
  turn.topLeftCorner<2, 2>() = geometry::rotation(-from_to.pose.heading_rad);
  constexpr double kLeastVariance = 1e-9;  // a covariance of zero has no finite information
  const geometry::Matrix3 covariance =
      turn * from_to.covariance * turn.transpose() + kLeastVariance * geometry::Matrix3::Identity();
  return covariance.ldlt().solve(geometry::Matrix3::Identity());
}

/// Latitude, longitude and direction of the x axis from east [rad] of the frame map. map_server
/// ignores the line.
std::string geo_origin_yaml(const std::optional<flow::Georeference>& georeference) {
  if (!georeference || !georeference->has_position) return {};
  return "geo_origin: [" + fixed_text(georeference->origin.latitude_deg, 9) + ", " +
         fixed_text(georeference->origin.longitude_deg, 9) + ", " +
         fixed_text(georeference->x_from_east_rad, 6) + "]\n";
}

std::optional<Error> write_map_files(const std::filesystem::path& folder, const std::string& name,
                                     const MapImage& image, const std::string& more_yaml) {
  const Result<std::string> png = to_png(image);
  if (!png) return png.error();
  if (auto fault = write_file_atomically(folder / (name + ".pgm"), to_pgm(image))) return fault;
  if (auto fault = write_file_atomically(folder / (name + ".png"), *png)) return fault;
  return write_file_atomically(folder / (name + ".yaml"),
                               to_map_server_yaml(image, name + ".pgm") + more_yaml);
}

/// Removes files of an earlier run, which would be mistaken for this one's.
std::optional<Error> write_labels(const std::filesystem::path& path,
                                  const std::vector<const LabelRow*>& rows) {
  if (!rows.empty()) return write_file_atomically(path, to_labels_csv(rows));
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return std::nullopt;
}

std::string pose_text(const geometry::Pose2& pose) {
  return fixed_text(pose.x_m, 9) + " " + fixed_text(pose.y_m, 9) + " " +
         fixed_text(pose.heading_rad, 9);
}

/// g2o readers skip lines that begin with '#'.
std::string closure_comment(const flow::Constraint& closure) {
  std::string text = "# closure " + std::to_string(closure.from.value) + " " +
                     std::to_string(closure.to.value) + " " + to_text(closure.verdict.state);
  text.append(" pose ")
      .append(pose_text(closure.from_to.pose))
      .append(" chi_square ")
      .append(fixed_text(closure.verdict.squared_error, 3));
  return text.append(" agreed ")
      .append(fixed_text(closure.verdict.agreed_share, 3))
      .append(" reason ")
      .append(closure.verdict.reason)
      .append("\n");
}

void append_after_comma(std::string& text, std::string_view word) {
  text.append(1, ',').append(word);
}

void append_fixed_after_comma(std::string& text, double value, int decimals) {
  append_fixed(text.append(1, ','), value, decimals);
}

void append_short_after_comma(std::string& text, double value) {
  append_short(text.append(1, ','), value);
}

void append_stamp_and_id(std::string& text, const TrackRow& row) {
  append_stamp(text, row.stamp_ns);
  append_after_comma(text, std::to_string(row.track_id.value));
}

std::optional<Error> write_maps(const std::filesystem::path& folder, const RunRecord& record) {
  std::vector<PlacedSubmap> placed;
  for (const auto& [id, submap] : record.submaps())
    placed.push_back({&submap, record.map_from_submap(submap)});
  const MapImages images = draw_map(placed);
  const std::string geo_origin = geo_origin_yaml(record.georeference());
  if (auto fault = write_map_files(folder, "map", images.stationary, geo_origin)) return fault;
  return write_map_files(folder, "moving", images.moving, geo_origin);
}

}  // namespace

std::string to_tum(const std::vector<StampedPose>& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 80);
  for (const auto& [stamp_ns, pose] : trajectory) {
    append_stamp(text, stamp_ns);
    append_fixed(text.append(1, ' '), pose.x_m, 6);
    append_fixed(text.append(1, ' '), pose.y_m, 6);
    append_fixed(text.append(" 0 0 0 "), std::sin(0.5 * pose.heading_rad), 9);
    append_fixed(text.append(1, ' '), std::cos(0.5 * pose.heading_rad), 9);
    text += '\n';
  }
  return text;
}

std::string to_tracks_csv(const std::vector<const TrackRow*>& rows) {
  std::string text =
      "timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class,occluded\n";
  for (const TrackRow* row : rows) {
    const geometry::Pose2& pose = row->map_from_object;
    const geometry::Vector2& velocity_mps = row->velocity_in_map_mps;
    append_stamp_and_id(text, *row);
    for (const double place_m : {pose.x_m, pose.y_m}) append_fixed_after_comma(text, place_m, 3);
    append_fixed_after_comma(text, pose.heading_rad, 5);
    for (const double value : {velocity_mps.x(), velocity_mps.y(), row->length_m, row->width_m})
      append_fixed_after_comma(text, value, 3);
    append_after_comma(text, name_of(row->motion));
    append_fixed_after_comma(text, row->existence, 4);
    append_after_comma(text, name_of(row->object_class));
    append_after_comma(text, row->occluded ? "1" : "0");
    text += '\n';
  }
  return text;
}

std::string to_track_details_csv(const std::vector<const TrackRow*>& rows) {
  std::string text =
      "timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy,p_pedestrian,p_bicycle,p_car,p_"
      "truck_or_bus";
  const std::size_t modes = rows.empty() ? 0 : rows.front()->mode_probability.size();
  for (std::size_t mode = 0; mode < modes; ++mode) text += ",mode_" + std::to_string(mode);
  text += "\n";
  for (const TrackRow* row : rows) {
    append_stamp_and_id(text, *row);
    const Eigen::Matrix4d& P = row->covariance_in_map;
    for (const double value : {P(0, 0), P(0, 1), P(1, 1), P(2, 2), P(2, 3), P(3, 3)})
      append_short_after_comma(text, value);
    for (const double probability : row->class_probability)
      append_fixed_after_comma(text, probability, 4);
    for (std::size_t mode = 0; mode < modes; ++mode)
      append_short_after_comma(
          text, mode < row->mode_probability.size() ? row->mode_probability[mode] : 0.0);
    text += '\n';
  }
  return text;
}

std::string to_predictions_csv(const std::vector<const TrackRow*>& rows) {
  std::string text = "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n";
  for (const TrackRow* row : rows) {
    for (const PredictedPlace& place : row->predicted) {
      append_stamp_and_id(text, *row);
      append_fixed_after_comma(text, place.after_s, 1);
      for (const double place_m : {place.position_in_map_m.x(), place.position_in_map_m.y()})
        append_fixed_after_comma(text, place_m, 3);
      const geometry::Matrix2& P = place.covariance_m2;
      for (const double value : {P(0, 0), P(0, 1), P(1, 1)}) append_short_after_comma(text, value);
      text += '\n';
    }
  }
  return text;
}

std::string to_online_covariance_csv(const std::vector<UncertainStampedPose>& poses) {
  std::string text = "timestamp,x,y,heading,var_x,cov_xy,cov_xh,var_y,cov_yh,var_h\n";
  for (const auto& [stamp_ns, odom_from_base] : poses) {
    const geometry::Pose2& pose = odom_from_base.pose;
    append_stamp(text, stamp_ns);
    for (const double place_m : {pose.x_m, pose.y_m}) append_fixed_after_comma(text, place_m, 6);
    append_fixed_after_comma(text, pose.heading_rad, 7);
    const geometry::Matrix3& P = odom_from_base.covariance;
    for (const double value : {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)})
      append_short_after_comma(text, value);
    text += '\n';
  }
  return text;
}

std::string to_labels_csv(const std::vector<const LabelRow*>& rows) {
  const bool has_several_scanners = std::ranges::any_of(
      rows, [&](const LabelRow* row) { return row->scanner_id != rows.front()->scanner_id; });
  std::string text = has_several_scanners ? "timestamp,detection,tracking,scanner\n"
                                          : "timestamp,detection,tracking\n";
  constexpr std::size_t kStampAndCommas = 48;
  std::size_t length = text.size();
  for (const LabelRow* row : rows)
    length += row->by_detection.size() + row->by_tracking.size() + kStampAndCommas;
  text.reserve(length);
  for (const LabelRow* row : rows) {
    append_stamp(text, row->stamp_ns);
    append_after_comma(text, row->by_detection);
    append_after_comma(text, row->by_tracking);
    if (has_several_scanners) append_after_comma(text, row->scanner_id);
    text += '\n';
  }
  return text;
}

std::string to_g2o(const RunRecord& record) {
  std::string text;
  for (const auto& [id, submap] : record.submaps()) {
    text.append("VERTEX_SE2 ")
        .append(std::to_string(id.value))
        .append(" ")
        .append(pose_text(record.map_from_submap(submap)))
        .append("\n");
  }
  if (!record.submaps().empty())
    text.append("FIX ").append(std::to_string(record.submaps().begin()->first.value)).append("\n");
  for (const flow::Constraint& constraint : record.constraints()) {
    if (constraint.kind == flow::ConstraintKind::kLoop) text += closure_comment(constraint);
    if (constraint.verdict.state != flow::ClosureState::kAccepted) continue;
    text.append("EDGE_SE2 ")
        .append(std::to_string(constraint.from.value))
        .append(" ")
        .append(std::to_string(constraint.to.value));
    text.append(" ").append(pose_text(constraint.from_to.pose));
    const geometry::Matrix3 information = information_at_end(constraint.from_to);
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column)
        text.append(" ").append(fixed_text(information(row, column), 6));
    }
    text += "\n";
  }
  return text;
}

double travelled_m(const std::vector<StampedPose>& trajectory) {
  constexpr double kCountedStepM = 0.1;  // smaller steps are noise of a standing vehicle
  if (trajectory.empty()) return 0.0;
  double sum_m = 0.0;
  geometry::Vector2 counted_m = trajectory.front().map_from_base.translation_m();
  for (const StampedPose& stamped : trajectory) {
    const double step_m = (stamped.map_from_base.translation_m() - counted_m).norm();
    if (step_m < kCountedStepM) continue;
    sum_m += step_m;
    counted_m = stamped.map_from_base.translation_m();
  }
  return sum_m;
}

std::optional<Error> write_map_outputs(const std::filesystem::path& folder, const RunRecord& record,
                                       const RunReport& report) {
  if (auto fault = write_file_atomically(folder / "graph.g2o", to_g2o(record))) return fault;
  if (auto fault = write_maps(folder, record)) return fault;
  return write_file_atomically(folder / "report.json", to_json_text(record, report, 0.0));
}

std::optional<Error> write_outputs(const std::filesystem::path& folder, const RunRecord& record,
                                   const RunReport& report) {
  // Drawing takes as long as writing all text.
  std::future<std::optional<Error>> maps =
      std::async(std::launch::async, [&] { return write_maps(folder, record); });
  const std::vector<StampedPose> corrected = record.corrected_trajectory();
  if (auto fault = write_file_atomically(folder / "online.tum", to_tum(record.online_trajectory())))
    return fault;
  if (auto fault = write_file_atomically(folder / "trajectory.tum", to_tum(corrected)))
    return fault;
  if (auto fault = write_file_atomically(folder / "online_covariance.csv",
                                         to_online_covariance_csv(record.uncertain_poses())))
    return fault;
  const std::vector<const TrackRow*> tracks = record.track_rows();
  if (auto fault = write_file_atomically(folder / "tracks.csv", to_tracks_csv(tracks)))
    return fault;
  if (auto fault =
          write_file_atomically(folder / "track_details.csv", to_track_details_csv(tracks)))
    return fault;
  if (auto fault = write_file_atomically(folder / "predictions.csv", to_predictions_csv(tracks)))
    return fault;
  if (auto fault = write_file_atomically(folder / "lanes.geojson", lanes_geojson(record)))
    return fault;
  if (auto fault = write_labels(folder / "labels.csv", record.label_rows())) return fault;
  if (auto fault = write_file_atomically(folder / "graph.g2o", to_g2o(record))) return fault;
  if (auto fault = maps.get()) return fault;
  return write_file_atomically(folder / "report.json",
                               to_json_text(record, report, travelled_m(corrected)));
}

}  // namespace slammot::files
