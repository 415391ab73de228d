#pragma once

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/flow/localized_scan.hpp"
#include "common/flow/submap.hpp"
#include "common/geometry/pose2.hpp"

namespace slammot::gateway {

/// A submap as viewers draw it, with its latest pose.
struct ShownSubmap {
  std::shared_ptr<const flow::Submap> submap;  ///< Reduced.
  std::string path;                            ///< Where the server has its cells.
  geometry::Pose2 map_from_submap;
};

/// One map of the vehicle: submaps, their poses, closures, and the way of the vehicle, which
/// follows corrections of its submaps.
class MapView {
 public:
  explicit MapView(flow::MapId map_id) : map_id_(map_id) {}

  flow::MapId map_id() const { return map_id_; }
  /// Returns the path under which the cells are to be served. `version` differs for each content of
  /// a submap.
  std::string add(std::shared_ptr<const flow::Submap> submap, std::uint64_t version);
  void add(const flow::Constraint& constraint);
  void correct(const flow::GraphCorrection& correction);
  /// Extends the way.
  void follow(const flow::LocalizedScan& scan);

  /// Submaps with poses, and all closures tried, as JSON.
  std::string graph_json() const;
  /// Poses on the way in map, at most kMostPoses.
  std::vector<geometry::Pose2> way() const;
  std::vector<ShownSubmap> submaps() const;

  static constexpr std::size_t kMostPoses = 2000;

 private:
  struct ConstraintKey {
    flow::SubmapId from, to;
    flow::ConstraintKind kind;
    auto operator<=>(const ConstraintKey&) const = default;
  };
  struct WayPoint {
    flow::SubmapId submap_id;
    geometry::Pose2 submap_from_base;
  };

  geometry::Pose2 pose_of(flow::SubmapId submap_id) const;
  void thin_out();

  flow::MapId map_id_;
  std::map<flow::SubmapId, ShownSubmap> submaps_;
  std::map<flow::SubmapId, geometry::Pose2> map_from_submap_;
  std::map<ConstraintKey, flow::Constraint> constraints_;
  std::vector<WayPoint> way_;
  double spacing_m_ = 0.5;  ///< Between poses of the way; doubles when there are too many.
};

}  // namespace slammot::gateway
