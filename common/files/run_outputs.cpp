#include "common/files/run_outputs.hpp"

#include <cmath>
#include <future>
#include <initializer_list>

#include <Eigen/Cholesky>

#include "common/files/atomic_file.hpp"
#include "common/files/decimal.hpp"
#include "common/files/map_image.hpp"

namespace slammot::files {
namespace {

const char* name_of(flow::Motion motion) { return motion == flow::Motion::kMoving ? "moving" : "stopped"; }

const char* name_of(flow::ObjectClass object_class) {
  switch (object_class) {
    case flow::ObjectClass::kUnknown: return "unknown";
    case flow::ObjectClass::kPedestrian: return "pedestrian";
    case flow::ObjectClass::kBicycle: return "bicycle";
    case flow::ObjectClass::kCar: return "car";
    case flow::ObjectClass::kTruckOrBus: return "truck_or_bus";
  }
  return "unknown";
}

geometry::Matrix3 information_at_end(const geometry::UncertainPose2& from_to) {
  geometry::Matrix3 turn = geometry::Matrix3::Identity();
  turn.topLeftCorner<2, 2>() = geometry::rotation(-from_to.pose.heading_rad);
  constexpr double kLeastVariance = 1e-9;  // a covariance of zero would be infinite information
  const geometry::Matrix3 covariance = turn * from_to.covariance * turn.transpose() + kLeastVariance * geometry::Matrix3::Identity();
  return covariance.ldlt().solve(geometry::Matrix3::Identity());
}

std::optional<Error> write_map_files(const std::filesystem::path& folder, const std::string& name, const MapImage& image) {
  const Result<std::string> png = to_png(image);
  if (!png) return png.error();
  if (auto fault = write_file_atomically(folder / (name + ".pgm"), to_pgm(image))) return fault;
  if (auto fault = write_file_atomically(folder / (name + ".png"), *png)) return fault;
  return write_file_atomically(folder / (name + ".yaml"), to_map_server_yaml(image, name + ".pgm"));
}

/// A file of an earlier run would be taken for one of this.
std::optional<Error> write_labels(const std::filesystem::path& path, const std::vector<LabelRow>& rows) {
  if (!rows.empty()) return write_file_atomically(path, to_labels_csv(rows));
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return std::nullopt;
}

std::string pose_text(const geometry::Pose2& pose) {
  return fixed_text(pose.x_m, 9) + " " + fixed_text(pose.y_m, 9) + " " + fixed_text(pose.heading_rad, 9);
}

/// The fields with commas between them, and the line's end.
void append_joined(std::string& text, std::initializer_list<std::string> fields) {
  for (const std::string& field : fields) text.append(field).append(1, ',');
  text.back() = '\n';
}

void append_short(std::string& text, double value) { text.append(1, ',').append(short_text(value)); }

std::optional<Error> write_maps(const std::filesystem::path& folder, const RunRecord& record) {
  std::vector<PlacedSubmap> placed;
  for (const auto& [id, submap] : record.submaps()) placed.push_back({&submap, record.map_from_submap(submap)});
  const MapImages images = draw_map(placed);
  if (auto fault = write_map_files(folder, "map", images.stationary)) return fault;
  return write_map_files(folder, "moving", images.moving);
}

}  // namespace

std::string to_tum(const std::vector<StampedPose>& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 64);
  for (const auto& [stamp_ns, pose] : trajectory) {
    text += stamp_text(stamp_ns) + " " + fixed_text(pose.x_m, 6) + " " + fixed_text(pose.y_m, 6) + " 0 0 0 " +
            fixed_text(std::sin(0.5 * pose.heading_rad), 9) + " " + fixed_text(std::cos(0.5 * pose.heading_rad), 9) + "\n";
  }
  return text;
}

std::string to_tracks_csv(const std::vector<TrackRow>& rows) {
  std::string text = "timestamp,track_id,x,y,heading,vx,vy,length,width,motion,existence,class\n";
  for (const TrackRow& row : rows) {
    const geometry::Pose2& pose = row.map_from_object;
    const geometry::Vector2& velocity_mps = row.velocity_in_map_mps;
    append_joined(text, {stamp_text(row.stamp_ns), std::to_string(row.track_id.value), fixed_text(pose.x_m, 3), fixed_text(pose.y_m, 3),
                         fixed_text(pose.heading_rad, 5), fixed_text(velocity_mps.x(), 3), fixed_text(velocity_mps.y(), 3),
                         fixed_text(row.length_m, 3), fixed_text(row.width_m, 3), name_of(row.motion), fixed_text(row.existence, 4),
                         name_of(row.object_class)});
  }
  return text;
}

std::string to_track_details_csv(const std::vector<TrackRow>& rows) {
  std::string text = "timestamp,track_id,var_x,cov_xy,var_y,var_vx,cov_vxy,var_vy,p_pedestrian,p_bicycle,p_car,p_truck_or_bus";
  const std::size_t modes = rows.empty() ? 0 : rows.front().mode_probability.size();
  for (std::size_t mode = 0; mode < modes; ++mode) text += ",mode_" + std::to_string(mode);
  text += "\n";
  for (const TrackRow& row : rows) {
    text.append(stamp_text(row.stamp_ns)).append(1, ',').append(std::to_string(row.track_id.value));
    const Eigen::Matrix4d& P = row.covariance_in_map;
    for (const double value : {P(0, 0), P(0, 1), P(1, 1), P(2, 2), P(2, 3), P(3, 3)}) append_short(text, value);
    for (const double probability : row.class_probability) text.append(1, ',').append(fixed_text(probability, 4));
    for (std::size_t mode = 0; mode < modes; ++mode) append_short(text, mode < row.mode_probability.size() ? row.mode_probability[mode] : 0.0);
    text += '\n';
  }
  return text;
}

std::string to_predictions_csv(const std::vector<TrackRow>& rows) {
  std::string text = "timestamp,track_id,after,x,y,var_x,cov_xy,var_y\n";
  for (const TrackRow& row : rows) {
    const std::string begin = stamp_text(row.stamp_ns) + "," + std::to_string(row.track_id.value) + ",";
    for (const PredictedPlace& place : row.predicted) {
      text.append(begin).append(fixed_text(place.after_s, 1));
      text.append(1, ',').append(fixed_text(place.position_in_map_m.x(), 3)).append(1, ',').append(fixed_text(place.position_in_map_m.y(), 3));
      const geometry::Matrix2& P = place.covariance_m2;
      for (const double value : {P(0, 0), P(0, 1), P(1, 1)}) append_short(text, value);
      text += '\n';
    }
  }
  return text;
}

std::string to_online_covariance_csv(const std::vector<UncertainStampedPose>& poses) {
  std::string text = "timestamp,x,y,heading,var_x,cov_xy,cov_xh,var_y,cov_yh,var_h\n";
  for (const auto& [stamp_ns, odom_from_base] : poses) {
    const geometry::Pose2& pose = odom_from_base.pose;
    text.append(stamp_text(stamp_ns)).append(1, ',').append(fixed_text(pose.x_m, 6)).append(1, ',').append(fixed_text(pose.y_m, 6));
    text.append(1, ',').append(fixed_text(pose.heading_rad, 7));
    const geometry::Matrix3& P = odom_from_base.covariance;
    for (const double value : {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2)}) append_short(text, value);
    text += '\n';
  }
  return text;
}

std::string to_labels_csv(const std::vector<LabelRow>& rows) {
  std::string text = "timestamp,detection,tracking\n";
  for (const LabelRow& row : rows) text.append(stamp_text(row.stamp_ns)).append(1, ',').append(row.by_detection).append(1, ',').append(row.by_tracking).append(1, '\n');
  return text;
}

std::string to_g2o(const RunRecord& record) {
  std::string text;
  for (const auto& [id, submap] : record.submaps()) {
    text.append("VERTEX_SE2 ").append(std::to_string(id.value)).append(" ").append(pose_text(record.map_from_submap(submap))).append("\n");
  }
  if (!record.submaps().empty()) text.append("FIX ").append(std::to_string(record.submaps().begin()->first.value)).append("\n");
  for (const flow::Constraint& constraint : record.constraints()) {
    text.append("EDGE_SE2 ").append(std::to_string(constraint.from.value)).append(" ").append(std::to_string(constraint.to.value));
    text.append(" ").append(pose_text(constraint.from_to.pose));
    const geometry::Matrix3 information = information_at_end(constraint.from_to);
    for (int row = 0; row < 3; ++row) {
      for (int column = row; column < 3; ++column) text.append(" ").append(fixed_text(information(row, column), 6));
    }
    text += "\n";
  }
  return text;
}

double travelled_m(const std::vector<StampedPose>& trajectory) {
  constexpr double kCountedStepM = 0.1;  // the noise of a vehicle at rest is no travel
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

std::optional<Error> write_outputs(const std::filesystem::path& folder, const RunRecord& record, const RunReport& report) {
  // Drawing takes as long as all the text does.
  std::future<std::optional<Error>> maps = std::async(std::launch::async, [&] { return write_maps(folder, record); });
  const std::vector<StampedPose> corrected = record.corrected_trajectory();
  if (auto fault = write_file_atomically(folder / "online.tum", to_tum(record.online_trajectory()))) return fault;
  if (auto fault = write_file_atomically(folder / "trajectory.tum", to_tum(corrected))) return fault;
  if (auto fault = write_file_atomically(folder / "online_covariance.csv", to_online_covariance_csv(record.uncertain_poses()))) return fault;
  const std::vector<TrackRow> tracks = record.track_rows();
  if (auto fault = write_file_atomically(folder / "tracks.csv", to_tracks_csv(tracks))) return fault;
  if (auto fault = write_file_atomically(folder / "track_details.csv", to_track_details_csv(tracks))) return fault;
  if (auto fault = write_file_atomically(folder / "predictions.csv", to_predictions_csv(tracks))) return fault;
  if (auto fault = write_labels(folder / "labels.csv", record.label_rows())) return fault;
  if (auto fault = write_file_atomically(folder / "graph.g2o", to_g2o(record))) return fault;
  if (auto fault = maps.get()) return fault;
  return write_file_atomically(folder / "report.json", to_json_text(record, report, travelled_m(corrected)));
}

}  // namespace slammot::files
