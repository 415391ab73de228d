#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "common/flow/tracked_objects.hpp"
#include "common/traffic/passage.hpp"

namespace slammot::traffic {

/// What kind of mover a track is: its class probabilities, summed over its states.
class MoverEvidence {
 public:
  void add(const flow::ClassProbabilities& probability) {
    const auto& [pedestrian, bicycle, car, truck_or_bus] = probability;
    at(Mover::kPedestrian) += pedestrian;
    at(Mover::kBicycle) += bicycle;
    at(Mover::kVehicle) += car + truck_or_bus;
  }

  /// None if no class was computed.
  std::optional<Mover> likeliest() const {
    const auto likeliest = std::ranges::max_element(sums_);
    if (*likeliest <= 0.0) return std::nullopt;
    return static_cast<Mover>(likeliest - sums_.begin());
  }

 private:
  double& at(Mover mover) { return sums_[static_cast<std::size_t>(mover)]; }

  std::array<double, kMovers> sums_ = {};
};

}  // namespace slammot::traffic
