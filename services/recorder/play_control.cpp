#include "services/recorder/play_control.hpp"

#include <utility>

namespace slammot::recorder {

PlayControl::PlayControl(app::Pace pace, double speed) : pace_(pace) { state_.speed = speed; }

void PlayControl::stop() {
  const std::scoped_lock lock(mutex_);
  is_stopped_ = true;
  changed_.notify_all();
}

void PlayControl::pause() {
  const std::scoped_lock lock(mutex_);
  state_.is_paused = true;
  step_until_ns_.reset();
  changed_.notify_all();
}

void PlayControl::go_on() {
  const std::scoped_lock lock(mutex_);
  state_.is_paused = false;
  step_until_ns_.reset();
  pace_.restart();
  changed_.notify_all();
}

void PlayControl::step(std::int64_t duration_ns) {
  const std::scoped_lock lock(mutex_);
  state_.is_paused = true;
  step_until_ns_ = state_.position_ns + duration_ns;
  changed_.notify_all();
}

void PlayControl::seek(std::int64_t log_time_ns) {
  const std::scoped_lock lock(mutex_);
  seek_ns_ = log_time_ns;
  changed_.notify_all();
}

void PlayControl::set_speed(app::Pace pace, double speed) {
  const std::scoped_lock lock(mutex_);
  pace_ = pace;
  state_.speed = speed;
  changed_.notify_all();
}

std::optional<PlayControl::Turn> PlayControl::other_turn() const {
  if (is_stopped_) return Turn::kStop;
  if (seek_ns_) return Turn::kSeek;
  return std::nullopt;
}

PlayControl::Turn PlayControl::await(std::int64_t log_time_ns) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (const auto turn = other_turn()) return *turn;
    const bool is_in_step = step_until_ns_ && log_time_ns <= *step_until_ns_;
    const auto now = Time::clock::now();
    const auto due = state_.is_paused || pace_.is_unlimited() ? now : pace_.due(log_time_ns, now);
    if (is_in_step || (!state_.is_paused && due <= now)) {
      state_.position_ns = log_time_ns;
      return Turn::kPlay;
    }
    if (state_.is_paused) changed_.wait(lock);
    else changed_.wait_until(lock, due);
  }
}

PlayControl::Turn PlayControl::await_command() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return other_turn().has_value(); });
  return *other_turn();
}

/// After a seek while paused the first moment is shown.
std::int64_t PlayControl::take_seek() {
  constexpr std::int64_t kShownNs = 200'000'000;
  const std::scoped_lock lock(mutex_);
  state_.position_ns = std::exchange(seek_ns_, std::nullopt).value_or(state_.position_ns);
  if (state_.is_paused) step_until_ns_ = state_.position_ns + kShownNs;
  pace_.restart();
  return state_.position_ns;
}

bool PlayControl::is_stopped() const {
  const std::scoped_lock lock(mutex_);
  return is_stopped_;
}

PlayState PlayControl::state() const {
  const std::scoped_lock lock(mutex_);
  return state_;
}

}  // namespace slammot::recorder
