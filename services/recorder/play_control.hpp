#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>

#include "common/app/pace.hpp"

namespace slammot::recorder {

/// Where playing is, and how it goes on.
struct PlayState {
  std::int64_t position_ns = 0;  ///< Log time of the message played last.
  bool is_paused = false;
  double speed = 1.0;  ///< Multiple of the recorded speed; infinite: as fast as possible.
};

/// What one thread plays and another one commands: pause, go on, step, seek, speed. Thread-safe.
class PlayControl {
 public:
  using Time = app::Pace::Time;

  PlayControl(app::Pace pace, double speed);

  void stop();
  void pause();
  void go_on();
  /// Plays so much recorded time, then pauses.
  void step(std::int64_t duration_ns);
  void seek(std::int64_t log_time_ns);
  void set_speed(app::Pace pace, double speed);

  enum class Turn { kPlay, kSeek, kStop };
  /// Waits until a message of this log time is to be played, or something else is to be done.
  Turn await(std::int64_t log_time_ns);
  /// Waits at the end of the recording until something else is to be done.
  Turn await_command();
  /// The time to go on from, after Turn::kSeek.
  std::int64_t take_seek();

  bool is_stopped() const;
  PlayState state() const;

 private:
  std::optional<Turn> other_turn() const;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  app::Pace pace_;
  PlayState state_;
  std::optional<std::int64_t> seek_ns_;
  std::optional<std::int64_t> step_until_ns_;
  bool is_stopped_ = false;
};

}  // namespace slammot::recorder
