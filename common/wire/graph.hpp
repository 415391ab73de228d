#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "common/flow/graph_correction.hpp"
#include "common/wire/decoded.hpp"
#include "common/wire/part_collector.hpp"
#include "idl/mapping.h"

namespace slammot::wire {

/// Most corrected submaps in one part.
inline constexpr std::uint32_t kMostSubmapsOfPart = 4000;
/// Most parts of one correction.
inline constexpr std::uint32_t kMostParts = 64;

slammot_Constraint encode(std::string_view vehicle_id, const flow::Constraint& constraint);
Decoded<flow::Constraint> decode(const slammot_Constraint& sample);

/// Splits corrections into parts that fit on the bus; reuses its buffers.
class GraphCorrectionEncoder {
 public:
  /// Calls `write` with each part, valid only during the call. Throws std::length_error for more
  /// than kMostParts * kMostSubmapsOfPart submaps.
  void encode(std::string_view vehicle_id, const flow::GraphCorrection& correction,
              const std::function<void(const slammot_GraphCorrection&)>& write);

 private:
  slammot_GraphCorrection sample_{};
  std::vector<slammot_CorrectedSubmap> submaps_;
  std::vector<slammot_Georeference> georeferences_;  ///< At most one.
};

/// Reassembles corrections from parts in any order. Use one a vehicle.
class GraphCorrectionAssembler {
 public:
  /// The correction if this was its last missing part; nothing (and no fault) if parts are missing.
  struct Added {
    std::optional<flow::GraphCorrection> correction;
    std::string_view fault;  ///< Reason of rejection; empty if accepted.
  };
  Added add(const slammot_GraphCorrection& part);

 private:
  struct Shared {
    flow::MapId map_id;
    geometry::Pose2 map_from_odom;
    bool is_untied = false;

    bool operator==(const Shared&) const = default;
  };

  PartCollector<Shared, flow::CorrectedSubmap> parts_;
};

}  // namespace slammot::wire
