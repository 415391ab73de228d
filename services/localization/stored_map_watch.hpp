#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/flow/graph_correction.hpp"
#include "common/flow/stored_map.hpp"

namespace slammot::localization {

/// Whether a drive can go on in the stored map: map_store has told what there is of it, and loop
/// closing has placed all that in its graph. Time is a parameter: nanoseconds of any clock that
/// does not go back.
class StoredMapWatch {
 public:
  enum class Verdict {
    kWait,  ///< Not yet known.
    kGoOn,
    kNothingStored,  ///< As before the first drive of all.
    kCannot,
  };
  struct Answer {
    Verdict verdict = Verdict::kWait;
    std::string reason;  ///< Of waiting, and why it cannot.
  };

  /// patience_ns: how long nothing may come before it is given up. cell_size_m: of this process'
  /// maps.
  StoredMapWatch(std::int64_t patience_ns, double cell_size_m, std::int64_t now_ns)
      : patience_ns_(patience_ns), cell_size_m_(cell_size_m), last_progress_ns_(now_ns) {}

  void is_stored(const flow::StoredMap& map, std::int64_t now_ns);
  void is_placed(const flow::GraphCorrection& correction, std::int64_t now_ns);

  /// A submap of the drive before is on its way there: the answer must know it.
  void is_on_its_way(flow::MapId map_id, flow::SubmapId submap_id, std::int64_t now_ns);

  Answer answer(std::int64_t now_ns) const;

  /// None until map_store has said it.
  const std::optional<flow::StoredMap>& map() const { return stored_; }
  /// Where its submaps lie; there where kGoOn is the answer.
  const flow::GraphCorrection& graph() const { return *placed_; }

 private:
  struct Submap {
    flow::MapId map_id;
    flow::SubmapId submap_id;
    bool operator==(const Submap&) const = default;
  };

  std::string fault() const;
  std::string missing() const;

  std::int64_t patience_ns_;
  double cell_size_m_;
  std::int64_t last_progress_ns_;
  std::optional<flow::StoredMap> stored_;
  std::optional<flow::GraphCorrection> placed_;
  std::optional<Submap> on_its_way_;
};

}  // namespace slammot::localization
