#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "common/sensing/scan.hpp"
#include "common/work/side_work.hpp"
#include "services/localization/keyframe_odometry.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"
#include "services/localization/localizer_counters.hpp"
#include "services/localization/pose_state.hpp"
#include "services/localization/submap_sequence.hpp"

namespace slammot::localization {

/// What a localizer goes on from after a crash, beside the local map.
struct Checkpoint {
  PoseState pose;  ///< Of a drive that has begun: its prediction has a last scan.
  SubmapSequence::State submaps;
  LocalizerCounters counters;
  std::vector<sensing::Odometry> odometry;
  KeyframeOdometry::State keyframes;
};

/// A localizer as it was: a value, which another thread may write.
struct LocalizerSnapshot {
  Checkpoint checkpoint;
  LocalMap::Snapshot map;
};

/// In a form of this build, with a checksum.
std::vector<std::byte> to_bytes(const LocalizerSnapshot& snapshot);

struct RestoredCheckpoint {
  Checkpoint checkpoint;
  LocalMap map;
};

/// before: of a new localizer; what the bytes do not hold is as in it. None when they are damaged
/// or the map in them has another shape than the configuration's. help, if any, becomes the map's.
std::optional<RestoredCheckpoint> checkpoint_of(std::span<const std::byte> bytes,
                                                const Checkpoint& before,
                                                const LocalMapConfig& config,
                                                work::SideWork* help = nullptr);

}  // namespace slammot::localization
