#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/flow/absolute_measurements.hpp"
#include "common/flow/ids.hpp"
#include "common/geometry/uncertain_pose2.hpp"

namespace slammot::flow {

enum class ConstraintKind : std::uint8_t { kOdometric, kLoop };

enum class ClosureState : std::uint8_t { kAccepted, kRejected, kWithdrawn };

constexpr const char* to_text(ClosureState state) {
  switch (state) {
    case ClosureState::kAccepted: return "accepted";
    case ClosureState::kRejected: return "rejected";
    case ClosureState::kWithdrawn: return "withdrawn";
  }
  return "";
}

/// Verdict of loop closing on a closure, with its reason.
struct ClosureVerdict {
  ClosureState state = ClosureState::kAccepted;
  double squared_error = 0.0;  ///< Squared Mahalanobis distance to the graph at the last decision:
                               ///< chi-square, 3 degrees of freedom.
  double agreed_share = 0.0;   ///< Share of the walls of both submaps that the other submap has not
                               ///< seen free.
  std::string reason;
};

/// Relative pose between two submaps, with its covariance in the frame of `from`.
struct Constraint {
  SubmapId from;
  SubmapId to;
  ConstraintKind kind = ConstraintKind::kOdometric;
  geometry::UncertainPose2 from_to;  ///< from_from_to: maps points of submap `to` into submap
                                     ///< `from`.
  MapId map_id{};
  ClosureVerdict verdict{};  ///< Of a closure; odometric ones are always accepted. Only accepted
                             ///< ones are in the graph.
};

struct CorrectedSubmap {
  SubmapId submap_id;
  geometry::Pose2 map_from_submap;
};

/// Submap poses estimated by loop closing.
struct GraphCorrection {
  std::uint32_t sequence = 0;     ///< Increases with every correction.
  geometry::Pose2 map_from_odom;  ///< Of the newest submap of the graph, which is the one in use.
  std::vector<CorrectedSubmap> submaps;  ///< All submaps of the graph, ascending.
  MapId map_id{};
  bool is_untied = false;  ///< The newest submap is not tied to the first one yet: map_from_odom is
                           ///< invalid.
  std::optional<Georeference> georeference{};  ///< None without GNSS and compass.
};

}  // namespace slammot::flow
