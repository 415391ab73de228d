#pragma once

#include <cstdint>
#include <string>
#include <vector>

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

/// What loop closing holds of a revisit, and why.
struct ClosureVerdict {
  ClosureState state = ClosureState::kAccepted;
  double squared_error = 0.0;        ///< Against the graph when this was last decided: chi-square, 3 degrees of freedom.
  double agreed_share = 0.0;         ///< Of the walls of either submap, those that the other has not seen free.
  std::string reason;
};

/// Relative pose between two submaps, with its covariance in the frame of `from`.
struct Constraint {
  SubmapId from;
  SubmapId to;
  ConstraintKind kind = ConstraintKind::kOdometric;
  geometry::UncertainPose2 from_to;  ///< from_from_to: maps points of submap `to` into submap `from`.
  MapId map_id{};
  ClosureVerdict verdict{};          ///< Of a loop; an odometric constraint is always accepted. Only accepted ones take part in the graph.
};

struct CorrectedSubmap {
  SubmapId submap_id;
  geometry::Pose2 map_from_submap;
};

/// Where loop closing now believes the submaps to be.
struct GraphCorrection {
  std::uint32_t sequence = 0;            ///< Grows with every correction.
  geometry::Pose2 map_from_odom;         ///< For the newest submap of the graph, and so for what is being driven now.
  std::vector<CorrectedSubmap> submaps;  ///< All submaps of the graph, ascending.
  MapId map_id{};
  bool is_untied = false;                ///< Nothing ties the newest submap to the first one yet: map_from_odom means nothing.
};

}  // namespace slammot::flow
