#include <utility>

#include "services/localization/localizer.hpp"

namespace slammot::localization {

Checkpoint Localizer::checkpoint_now() const {
  return {prediction_.state(), monitor_.state(), covariance_.state(),           sweep_.factor(),
          submaps_.state(),    counters_,        prediction_.recent_odometry(), keyframes_.state()};
}

std::optional<LocalizerSnapshot> Localizer::snapshot(LocalMap::Snapshot memory) const {
  if (!prediction_.last()) return std::nullopt;
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
  restored.resume(*std::move(content), std::move(prediction_));
  *this = std::move(restored);
  return true;
}

void Localizer::resume(RestoredCheckpoint restored, OdometryPrediction&& before) {
  const Checkpoint& checkpoint = restored.checkpoint;
  prediction_.resume(checkpoint.prediction, checkpoint.odometry, std::move(before));
  monitor_.set_state(checkpoint.monitor);
  covariance_.set_state(checkpoint.covariance);
  sweep_.set_factor(checkpoint.sweep_factor);
  counters_ = checkpoint.counters;
  keyframes_.resume(checkpoint.keyframes);
  episodes_.begin(checkpoint.prediction.last->stamp_ns);
  submaps_.resume(checkpoint.submaps, std::move(restored.map));
}

}  // namespace slammot::localization
