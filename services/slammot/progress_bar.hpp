#pragma once

#include <chrono>
#include <string>

namespace slammot {

/// Progress line on stderr; silent if stderr is no terminal. Clears the line when destroyed.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// `fraction` in [0, 1]; `note` follows the bar.
  void show(double fraction, const std::string& note = "");

  /// Prints a separate line above the bar, also if stderr is no terminal.
  void say(const std::string& line);

 private:
  std::string title_;
  bool is_terminal_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

/// "[=====>    ]  52 %"
std::string bar_text(double fraction, int width);

}  // namespace slammot
