#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/ids.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/scan_labels.hpp"
#include "common/flow/segmented_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::files {

struct StampedPose {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 map_from_base;
};

/// "car", "truck_or_bus", ... as in tracks.csv.
const char* name_of(flow::ObjectClass object_class);

/// Predicted position of a track in map.
struct PredictedPlace {
  double after_s = 0.0;
  geometry::Vector2 position_in_map_m = geometry::Vector2::Zero();
  geometry::Matrix2 covariance_m2 = geometry::Matrix2::Zero();
};

/// A confirmed track at the time of one scan, in map as published live.
struct TrackRow {
  std::int64_t stamp_ns = 0;
  flow::TrackId track_id;
  geometry::Pose2 map_from_object;  ///< Centre and heading of the box.
  geometry::Vector2 velocity_in_map_mps = geometry::Vector2::Zero();
  double length_m = 0.0;
  double width_m = 0.0;
  flow::Motion motion = flow::Motion::kMoving;
  double existence = 0.0;
  flow::ObjectClass object_class = flow::ObjectClass::kUnknown;
  Eigen::Matrix4d covariance_in_map = Eigen::Matrix4d::Zero();  ///< (x, y [m], vx, vy [m/s])
  std::vector<double> mode_probability;  ///< Of each motion model, as tracking orders them.
  flow::ClassProbabilities class_probability = {};  ///< Of pedestrian, bicycle, car, truck or bus.
  std::vector<PredictedPlace> predicted;  ///< Those of its path that are whole seconds ahead.
  bool occluded = false;                  ///< Predicted, without an echo in this scan.
};

/// A pose as published live, with its covariance relative to the local map, and odom_from_base.
struct UncertainStampedPose {
  std::int64_t stamp_ns = 0;
  geometry::UncertainPose2 odom_from_base;
};

/// Labels of one scan's points, one letter a beam: '-' no echo, 's' stationary, 'm' moving, '?'
/// unknown.
struct LabelRow {
  std::int64_t stamp_ns = 0;
  std::string by_detection;  ///< Empty if none was received.
  std::string by_tracking;
  std::string scanner_id;
};

/// Results of a drive, collected scan by scan from the stages of one process or from the services
/// on the bus. Entries are keyed by stamp or id, and repeated ones replace earlier ones, so that
/// neither order of arrival nor restarts matter.
class RunRecord {
 public:
  /// Adds every scan of the log in order, whether it is processed or not.
  void add_scan(std::int64_t stamp_ns) { scan_stamps_ns_.push_back(stamp_ns); }

  void add(const flow::LocalizedScan& scan);
  void add(const flow::TrackedObjects& tracked);  ///< Skips tentative tracks.
  void add(const flow::SegmentedScan& segmented);
  void add(const flow::ScanLabels& labels);
  void add(flow::Submap submap);
  void add(const flow::Constraint& constraint);
  void add(const flow::GraphCorrection& correction);  ///< Ignored if older than the last one.

  /// Starts another drive in the same map: clears scans and objects.
  void forget_drive();

  std::uint64_t scans() const { return scan_stamps_ns_.size(); }
  std::uint64_t localized_scans() const { return poses_.size() + same_stamp_.size(); }
  const std::map<flow::SubmapId, flow::Submap>& submaps() const { return submaps_; }
  std::vector<flow::Constraint> constraints() const;
  std::vector<const TrackRow*> track_rows() const;  ///< This and the next result are valid until
                                                    ///< the next add().
  std::vector<UncertainStampedPose> uncertain_poses() const;  ///< Of the scans that were localized.
  std::vector<const LabelRow*> label_rows() const;
  std::uint64_t confirmed_tracks() const;  ///< Number of distinct confirmed tracks.

  /// For progress: pose of the newest scan as published live, nothing before the first one; number
  /// of confirmed tracks in the newest scan.
  std::optional<geometry::Pose2> last_pose() const;
  std::size_t tracks_now() const { return tracks_.empty() ? 0 : tracks_.rbegin()->second.size(); }

  /// Submap pose after the last correction; by odometry if loop closing has not received the
  /// submap.
  geometry::Pose2 map_from_submap(const flow::Submap& submap) const;

  /// True if constraints connect the newest submap to the first one after the last correction.
  bool is_connected() const { return !correction_.is_untied; }

  /// Place of the map on the earth after the last correction; none without GNSS and compass.
  const std::optional<flow::Georeference>& georeference() const { return correction_.georeference; }

  /// One pose for every scan of the log, as published live; scans of several scanners that share a
  /// stamp share the pose. A scan that was dropped or lost is given the pose between its neighbours
  /// in time.
  std::vector<StampedPose> online_trajectory() const;

  /// The same after the last correction: pose in the submap, with the submap's corrected pose.
  std::vector<StampedPose> corrected_trajectory() const;

  /// Moves what was published live in map at that time to where the last correction places it.
  geometry::Pose2 corrected_from_online(std::int64_t stamp_ns) const;

 private:
  struct LocalizedPose {
    std::string scanner_id;
    geometry::Pose2 map_from_base;
    geometry::UncertainPose2 odom_from_base;
    flow::SubmapId submap_id;
    geometry::Pose2 submap_from_base;
  };

  using ScanName = std::pair<std::int64_t, std::string>;  ///< Stamp and scanner.

  geometry::Pose2 corrected(std::int64_t stamp_ns, const LocalizedPose& pose) const;
  std::vector<StampedPose> one_pose_a_scan(
      const std::map<std::int64_t, geometry::Pose2>& poses_by_stamp) const;

  std::vector<std::int64_t> scan_stamps_ns_;
  std::map<std::int64_t, LocalizedPose> poses_;  // by stamp; the last one of several scanners'
                                                 // scans
  std::set<ScanName> same_stamp_;  // by stamp; the last one if several scanners share a stamp
  std::map<std::int64_t, std::vector<TrackRow>> tracks_;  // by stamp
  std::map<ScanName, LabelRow> labels_;
  std::map<flow::SubmapId, flow::Submap> submaps_;
  std::map<std::tuple<flow::SubmapId, flow::SubmapId, flow::ConstraintKind>, flow::Constraint>
      constraints_;
  flow::GraphCorrection correction_;
  std::map<flow::SubmapId, geometry::Pose2> corrected_submaps_;
};

}  // namespace slammot::files
