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

/// Where a track is said to be some time later, in map.
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
  std::vector<double> mode_probability;                         ///< Of each motion model, as tracking orders them.
  flow::ClassProbabilities class_probability = {};              ///< Of pedestrian, bicycle, car, truck or bus.
  std::vector<PredictedPlace> predicted;                        ///< Those of its path that are whole seconds ahead.
};

/// A pose as published live, with its covariance against the local map, and the frame that never jumps.
struct UncertainStampedPose {
  std::int64_t stamp_ns = 0;
  geometry::UncertainPose2 odom_from_base;
};

/// What the points of one scan were held to be, a letter a beam: '-' no echo, 's' stationary, 'm' moving, '?' unknown.
struct LabelRow {
  std::int64_t stamp_ns = 0;
  std::string by_detection;  ///< Empty where nothing came.
  std::string by_tracking;
  std::string scanner_id;
};

/// What came out of a drive, collected scan by scan from whoever made it: the stages of one process or the services on
/// the bus. Everything is known by its stamp or id, and what comes again replaces what came before, so that neither
/// the order of arrival nor a restarted service matters.
class RunRecord {
 public:
  /// Every scan of the log, in its order, whatever becomes of it.
  void add_scan(std::int64_t stamp_ns) { scan_stamps_ns_.push_back(stamp_ns); }

  void add(const flow::LocalizedScan& scan);
  void add(const flow::TrackedObjects& tracked);  ///< Tentative tracks are left out.
  void add(const flow::SegmentedScan& segmented);
  void add(const flow::ScanLabels& labels);
  void add(flow::Submap submap);
  void add(const flow::Constraint& constraint);
  void add(const flow::GraphCorrection& correction);  ///< An older one than the last is ignored.

  /// Another drive goes on in the same map: of scans and objects nothing is kept.
  void forget_drive();

  std::uint64_t scans() const { return scan_stamps_ns_.size(); }
  std::uint64_t localized_scans() const { return poses_.size() + same_stamp_.size(); }
  const std::map<flow::SubmapId, flow::Submap>& submaps() const { return submaps_; }
  std::vector<flow::Constraint> constraints() const;
  std::vector<const TrackRow*> track_rows() const;            ///< These and the next stay where they are until more is added.
  std::vector<UncertainStampedPose> uncertain_poses() const;  ///< Of the scans that were localized.
  std::vector<const LabelRow*> label_rows() const;
  std::uint64_t confirmed_tracks() const;  ///< Different ones.

  /// Where the submap is after the last correction; by odometry where loop closing never heard of it.
  geometry::Pose2 map_from_submap(const flow::Submap& submap) const;

  /// Whether the newest submap is tied to the first one, after the last correction.
  bool knows_where_it_is() const { return !correction_.is_untied; }

  /// One pose for every scan of the log, as published live; scans of several scanners that share a stamp share the pose. A scan that was dropped or lost is given the pose between
  /// its neighbours in time.
  std::vector<StampedPose> online_trajectory() const;

  /// The same after the last correction: the pose in its submap, and the submap where it is now.
  std::vector<StampedPose> corrected_trajectory() const;

 private:
  struct LocalizedPose {
    std::string scanner_id;
    geometry::Pose2 map_from_base;
    geometry::UncertainPose2 odom_from_base;
    flow::SubmapId submap_id;
    geometry::Pose2 submap_from_base;
  };

  using ScanName = std::pair<std::int64_t, std::string>;    ///< Stamp and scanner.

  geometry::Pose2 corrected(const LocalizedPose& pose) const;
  std::vector<StampedPose> one_pose_a_scan(const std::map<std::int64_t, geometry::Pose2>& poses_by_stamp) const;

  std::vector<std::int64_t> scan_stamps_ns_;
  std::map<std::int64_t, LocalizedPose> poses_;             // by stamp; the last one of several scanners' scans
  std::set<ScanName> same_stamp_;                           // those that shared a stamp with one that came before
  std::map<std::int64_t, std::vector<TrackRow>> tracks_;    // by stamp
  std::map<ScanName, LabelRow> labels_;
  std::map<flow::SubmapId, flow::Submap> submaps_;
  std::map<std::tuple<flow::SubmapId, flow::SubmapId, flow::ConstraintKind>, flow::Constraint> constraints_;
  flow::GraphCorrection correction_;
  std::map<flow::SubmapId, geometry::Pose2> corrected_submaps_;
};

}  // namespace slammot::files
