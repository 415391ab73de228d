#include "common/files/run_record.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <string_view>

namespace slammot::files {
namespace {

std::vector<PredictedPlace> at_whole_seconds(const flow::TrackedObject& object,
                                             const geometry::Pose2& map_from_odom) {
  constexpr double kSameS = 1e-6;
  const geometry::Matrix2 turn = geometry::rotation(map_from_odom.heading_rad);
  std::vector<PredictedPlace> places;
  places.reserve(object.predicted_path.size());
  for (const flow::PredictedPosition& place : object.predicted_path) {
    if (std::abs(place.after_s - std::round(place.after_s)) > kSameS) continue;
    places.push_back({place.after_s, map_from_odom * place.position_in_odom_m,
                      turn * place.covariance_m2 * turn.transpose()});
  }
  return places;
}

TrackRow row_of(const flow::TrackedObject& object, const flow::TrackedObjects& tracked) {
  const geometry::Pose2 odom_from_object{object.position_in_odom_m.x(),
                                         object.position_in_odom_m.y(), object.heading_in_odom_rad};
  TrackRow row;
  row.stamp_ns = tracked.stamp_ns;
  row.track_id = object.track_id;
  row.map_from_object = tracked.map_from_odom * odom_from_object;
  row.velocity_in_map_mps =
      geometry::rotation(tracked.map_from_odom.heading_rad) * object.velocity_in_odom_mps;
  row.length_m = object.length_m;
  row.width_m = object.width_m;
  row.motion = object.motion;
  row.existence = object.existence;
  row.object_class = object.object_class;
  Eigen::Matrix4d turn = Eigen::Matrix4d::Zero();
  turn.topLeftCorner<2, 2>() = turn.bottomRightCorner<2, 2>() =
      geometry::rotation(tracked.map_from_odom.heading_rad);
  row.covariance_in_map = turn * object.covariance * turn.transpose();
  row.mode_probability.assign(object.mode_probability.begin(), object.mode_probability.end());
  row.class_probability = object.class_probability;
  row.predicted = at_whole_seconds(object, tracked.map_from_odom);
  row.occluded = object.occluded;
  return row;
}

/// Table look-up: labels vary too much for branch prediction.
constexpr std::string_view kLetters = "-sm?";
static_assert(kLetters[static_cast<std::size_t>(flow::PointLabel::kNoEcho)] == '-' &&
              kLetters[static_cast<std::size_t>(flow::PointLabel::kStationary)] == 's' &&
              kLetters[static_cast<std::size_t>(flow::PointLabel::kMoving)] == 'm' &&
              kLetters[static_cast<std::size_t>(flow::PointLabel::kUnknown)] == '?');

char letter_of(flow::PointLabel label) {
  return kLetters[std::min(static_cast<std::size_t>(label), kLetters.size() - 1)];
}

std::string letters_of(const std::vector<flow::PointLabel>& labels) {
  std::string letters(labels.size(), '?');
  std::ranges::transform(labels, letters.begin(), letter_of);
  return letters;
}

/// Interpolates between the neighbours in time; clamps to the first and the last pose.
geometry::Pose2 pose_at(const std::map<std::int64_t, geometry::Pose2>& poses_by_stamp,
                        std::int64_t stamp_ns) {
  const auto after = poses_by_stamp.lower_bound(stamp_ns);
  if (after == poses_by_stamp.end())
    return poses_by_stamp.empty() ? geometry::Pose2::identity() : poses_by_stamp.rbegin()->second;
  if (after->first == stamp_ns || after == poses_by_stamp.begin()) return after->second;
  const auto before = std::prev(after);
  const double fraction = static_cast<double>(stamp_ns - before->first) /
                          static_cast<double>(after->first - before->first);
  return geometry::interpolate(before->second, after->second, fraction);
}

}  // namespace

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

void RunRecord::add(const flow::LocalizedScan& scan) {
  LocalizedPose& pose = poses_[scan.stamp_ns];
  if (!pose.scanner_id.empty() && pose.scanner_id != scan.scanner_id)
    same_stamp_.emplace(scan.stamp_ns, scan.scanner_id);
  const std::string& first_scanner_id = pose.scanner_id.empty() ? scan.scanner_id : pose.scanner_id;
  pose = {first_scanner_id, scan.map_from_odom * scan.odom_from_base.pose, scan.odom_from_base,
          scan.submap_id, scan.submap_from_base};
}

void RunRecord::add(const flow::TrackedObjects& tracked) {
  std::vector<TrackRow> rows;
  rows.reserve(static_cast<std::size_t>(
      std::ranges::count_if(tracked.objects, &flow::TrackedObject::confirmed)));
  for (const flow::TrackedObject& object : tracked.objects) {
    if (object.confirmed) rows.push_back(row_of(object, tracked));
  }
  tracks_[tracked.stamp_ns] = std::move(rows);
}

void RunRecord::add(const flow::SegmentedScan& segmented) {
  LabelRow& row = labels_[{segmented.stamp_ns, segmented.scanner_id}];
  row.stamp_ns = segmented.stamp_ns;
  row.scanner_id = segmented.scanner_id;
  row.by_detection = letters_of(segmented.labels);
}

void RunRecord::add(const flow::ScanLabels& labels) {
  LabelRow& row = labels_[{labels.stamp_ns, labels.scanner_id}];
  row.stamp_ns = labels.stamp_ns;
  row.scanner_id = labels.scanner_id;
  row.by_tracking = letters_of(labels.labels);
}

void RunRecord::add(flow::Submap submap) {
  const flow::SubmapId id = submap.submap_id;
  submaps_.insert_or_assign(id, std::move(submap));
}

void RunRecord::add(const flow::Constraint& constraint) {
  constraints_[{constraint.from, constraint.to, constraint.kind}] = constraint;
}

void RunRecord::add(const flow::GraphCorrection& correction) {
  if (correction.sequence < correction_.sequence) return;
  correction_ = correction;
  for (const flow::CorrectedSubmap& submap : correction.submaps)
    corrected_submaps_[submap.submap_id] = submap.map_from_submap;
}

void RunRecord::forget_drive() {
  scan_stamps_ns_.clear();
  poses_.clear();
  same_stamp_.clear();
  tracks_.clear();
  labels_.clear();
}

std::vector<flow::Constraint> RunRecord::constraints() const {
  std::vector<flow::Constraint> all;
  for (const auto& [ends, constraint] : constraints_) all.push_back(constraint);
  return all;
}

std::vector<const TrackRow*> RunRecord::track_rows() const {
  std::vector<const TrackRow*> all;
  for (const auto& [stamp_ns, rows] : tracks_) {
    for (const TrackRow& row : rows) all.push_back(&row);
  }
  return all;
}

std::vector<UncertainStampedPose> RunRecord::uncertain_poses() const {
  std::vector<UncertainStampedPose> all;
  for (const auto& [stamp_ns, pose] : poses_) all.push_back({stamp_ns, pose.odom_from_base});
  return all;
}

std::vector<const LabelRow*> RunRecord::label_rows() const {
  std::vector<const LabelRow*> all;
  for (const auto& [scan, row] : labels_) all.push_back(&row);
  return all;
}

std::optional<geometry::Pose2> RunRecord::last_pose() const {
  if (poses_.empty()) return std::nullopt;
  return poses_.rbegin()->second.map_from_base;
}

std::uint64_t RunRecord::confirmed_tracks() const {
  std::set<flow::TrackId> ids;
  for (const auto& [stamp_ns, rows] : tracks_) {
    for (const TrackRow& row : rows) ids.insert(row.track_id);
  }
  return ids.size();
}

geometry::Pose2 RunRecord::map_from_submap(const flow::Submap& submap) const {
  const auto known = corrected_submaps_.find(submap.submap_id);
  return known != corrected_submaps_.end() ? known->second
                                           : correction_.map_from_odom * submap.odom_from_submap;
}

/// Poses while the vehicle was lost count from the submap that began when it was not found: by then
/// it was no longer where the one before lies.
geometry::Pose2 RunRecord::corrected(std::int64_t stamp_ns, const LocalizedPose& pose) const {
  const auto next = submaps_.upper_bound(pose.submap_id);
  if (next != submaps_.end() && next->second.first_stamp_ns <= stamp_ns) {
    const flow::Submap& submap = next->second;
    return map_from_submap(submap) * geometry::inverse(submap.odom_from_submap) *
           pose.odom_from_base.pose;
  }
  const auto known = corrected_submaps_.find(pose.submap_id);
  if (known != corrected_submaps_.end()) return known->second * pose.submap_from_base;
  return correction_.map_from_odom * pose.odom_from_base.pose;
}

std::vector<StampedPose> RunRecord::online_trajectory() const {
  std::map<std::int64_t, geometry::Pose2> poses;
  for (const auto& [stamp_ns, pose] : poses_)
    poses.emplace_hint(poses.end(), stamp_ns, pose.map_from_base);
  return one_pose_a_scan(poses);
}

std::vector<StampedPose> RunRecord::corrected_trajectory() const {
  std::map<std::int64_t, geometry::Pose2> poses;
  for (const auto& [stamp_ns, pose] : poses_)
    poses.emplace_hint(poses.end(), stamp_ns, corrected(stamp_ns, pose));
  return one_pose_a_scan(poses);
}

geometry::Pose2 RunRecord::corrected_from_online(std::int64_t stamp_ns) const {
  if (poses_.empty()) return geometry::Pose2::identity();
  auto near = poses_.lower_bound(stamp_ns);
  if (near == poses_.end()) --near;
  return corrected(near->first, near->second) * geometry::inverse(near->second.map_from_base);
}

std::vector<StampedPose> RunRecord::one_pose_a_scan(
    const std::map<std::int64_t, geometry::Pose2>& poses_by_stamp) const {
  std::vector<StampedPose> trajectory;
  trajectory.reserve(scan_stamps_ns_.size());
  for (const std::int64_t stamp_ns : scan_stamps_ns_)
    trajectory.push_back({stamp_ns, pose_at(poses_by_stamp, stamp_ns)});
  return trajectory;
}

}  // namespace slammot::files
