#pragma once

#include <chrono>
#include <string>

namespace slammot {

/// One line on stderr that tells how far the work is. Silent where stderr is no terminal. Leaves
/// the line clean.
class ProgressBar {
 public:
  explicit ProgressBar(std::string what);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// fraction in [0, 1]; note is shown behind the bar.
  void show(double fraction, const std::string& note = "");

  /// A line of its own above the bar, also where stderr is no terminal.
  void say(const std::string& line);

 private:
  std::string what_;
  bool is_terminal_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point next_;
};

/// "[=====>    ]  52 %"
std::string bar_text(double fraction, int width);

}  // namespace slammot
