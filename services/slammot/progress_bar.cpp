#include "services/slammot/progress_bar.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <unistd.h>

#include "common/files/text.hpp"

namespace slammot {
namespace {

constexpr int kWidth = 24;
constexpr std::chrono::milliseconds kBetweenUpdates{100};
constexpr std::chrono::seconds kBetweenLines{10};
constexpr const char* kClearLine = "\r\033[K";
constexpr double kLeastFraction = 0.01;  // for an estimate of the time left

}  // namespace

ProgressBar::ProgressBar(std::string what, Verbosity verbosity)
    : title_(std::move(what)),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      is_quiet_(verbosity == Verbosity::kQuiet),
      start_(Clock::now()),
      next_(is_terminal_ ? start_ : start_ + kBetweenLines) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_ && !is_quiet_) std::fputs(kClearLine, stderr);
}

bool ProgressBar::is_due() const { return !is_quiet_ && Clock::now() >= next_; }

void ProgressBar::show(double fraction, double driven_s, const std::string& note) {
  if (!is_due()) return;
  const auto now = Clock::now();
  next_ = is_terminal_ ? now + kBetweenUpdates : now + kBetweenLines;
  const std::string rest =
      pace_text(fraction, driven_s, std::chrono::duration<double>(now - start_).count()) +
      (note.empty() ? "" : ", " + note);
  if (is_terminal_) {
    std::fprintf(stderr, "%s%s %s %s", kClearLine, title_.c_str(),
                 bar_text(fraction, kWidth).c_str(), rest.c_str());
  } else {
    std::fprintf(stderr, "%s: %.0f %%, %s\n", title_.c_str(),
                 100.0 * std::clamp(fraction, 0.0, 1.0), rest.c_str());
  }
  std::fflush(stderr);
}

void ProgressBar::say(const std::string& line) {
  std::fprintf(stderr, "%s%s\n", is_terminal_ && !is_quiet_ ? kClearLine : "", line.c_str());
}

std::string bar_text(double fraction, int width) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(fraction * width);
  std::string bar(filled, '=');
  bar.resize(static_cast<std::size_t>(width), ' ');
  if (filled < bar.size()) bar[filled] = '>';
  return "[" + bar + "] " + files::text("%3.0f %%", 100.0 * fraction);
}

std::string pace_text(double fraction, double driven_s, double elapsed_s) {
  std::string pace = files::text("%.1fx real time", driven_s / std::max(elapsed_s, 1e-3));
  if (fraction >= kLeastFraction)
    pace +=
        files::text(", %.0f s left", std::ceil(elapsed_s * std::max(0.0, 1.0 / fraction - 1.0)));
  return pace;
}

}  // namespace slammot
