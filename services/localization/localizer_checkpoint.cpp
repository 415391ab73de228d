#include <utility>

#include "services/localization/localizer.hpp"

namespace slammot::localization {

Checkpoint Localizer::checkpoint_now() const {
  return {.pose = estimator_.state(),
          .submaps = submaps_.state(),
          .counters = counters_,
          .odometry = prediction().recent_odometry(),
          .keyframes = estimator_.keyframes()};
}

std::optional<LocalizerSnapshot> Localizer::snapshot(LocalMap::Snapshot memory) const {
  if (!prediction().last()) return std::nullopt;
  return LocalizerSnapshot{checkpoint_now(), submaps_.map().snapshot(std::move(memory))};
}

std::vector<std::byte> Localizer::checkpoint() const {
  const auto now = snapshot();
  return now ? to_bytes(*now) : std::vector<std::byte>{};
}

bool Localizer::restore(std::span<const std::byte> bytes) {
  Localizer restored(config_, submaps_.help());
  auto content = checkpoint_of(bytes, restored.checkpoint_now(), config_.map, submaps_.help());
  if (!content) return false;
  restored.resume(*std::move(content), std::move(estimator_));
  *this = std::move(restored);
  return true;
}

void Localizer::resume(RestoredCheckpoint restored, PoseEstimator&& before) {
  estimator_.resume(restored.checkpoint, std::move(before));
  counters_ = restored.checkpoint.counters;
  submaps_.resume(restored.checkpoint.submaps, std::move(restored.map));
}

}  // namespace slammot::localization
