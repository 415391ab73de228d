#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/simulation/drive.hpp"
#include "common/wire/decoded.hpp"
#include "idl/truth.h"

/// What a simulator knows of one scan; how to read it back is for tests and for whoever judges
/// live.
namespace slammot::wire {

/// Most objects that one sample carries: of more the nearest.
inline constexpr std::size_t kMostTrueObjects = 1500;

/// Puts the truth of the scans of one drive on the wire. Keeps its buffers; each result is good
/// until the next call.
class TruthEncoder {
 public:
  explicit TruthEncoder(std::uint64_t drive_id = 0);

  const slammot_TruePose& encode_pose(std::string_view vehicle_id,
                                      const simulation::SimulatedScan& scan);
  const slammot_TrueObjects& encode_objects(std::string_view vehicle_id,
                                            const simulation::SimulatedScan& scan);
  const slammot_TrueHits& encode_hits(std::string_view vehicle_id,
                                      const simulation::SimulatedScan& scan);

 private:
  slammot_TruePose pose_{};
  slammot_TrueObjects objects_{};
  slammot_TrueHits hits_{};
  std::vector<slammot_TrueObject> object_buffer_;
  std::vector<std::int32_t> hit_buffer_;
};

struct TruePose {
  std::int64_t stamp_ns = 0;
  geometry::Pose2 world_from_base;
  double speed_mps = 0.0;
  double yaw_rate_radps = 0.0;
  double nose_down_rad = 0.0;
};
Decoded<TruePose> decode(const slammot_TruePose& sample);

struct TrueObjects {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::string scanner_id;
  std::vector<simulation::ObjectTruth> objects;
};
Decoded<TrueObjects> decode(const slammot_TrueObjects& sample);

struct TrueHits {
  std::int64_t stamp_ns = 0;
  std::uint32_t sequence = 0;
  std::string scanner_id;
  std::vector<int> hits;  ///< As SimulatedScan::hits.
};
Decoded<TrueHits> decode(const slammot_TrueHits& sample);

}  // namespace slammot::wire
