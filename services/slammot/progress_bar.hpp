#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace slammot {

enum class Verbosity { kNormal, kQuiet };

/// Progress on stderr: a line that is replaced ten times a second, or, where stderr is no terminal,
/// a plain line every ten seconds. Clears the line when destroyed.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what, Verbosity verbosity = Verbosity::kNormal);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// True if show() has something to print now.
  bool is_due() const;

  /// `fraction` in [0, 1], of the whole; `driven_s`: of the drive's time; `note` follows.
  void show(double fraction, double driven_s, const std::string& note = "");

  /// Prints a separate line above the bar, also if stderr is no terminal, or quiet.
  void say(const std::string& line);

 private:
  using Clock = std::chrono::steady_clock;

  std::string title_;
  bool is_terminal_ = false;
  bool is_quiet_ = false;
  Clock::time_point start_;
  Clock::time_point next_;
};

/// "[=====>    ]  52 %"
std::string bar_text(double fraction, int width);

/// "12.5x real time, 8 s left". No time left is stated in the first percent.
std::string pace_text(double fraction, double driven_s, double elapsed_s);

}  // namespace slammot
