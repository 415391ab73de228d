#include "services/slammot/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace slammot {
namespace {

constexpr int kWidth = 40;
constexpr std::chrono::milliseconds kBetweenUpdates{100};
constexpr const char* kClearLine = "\r\033[K";

}  // namespace

ProgressBar::ProgressBar(std::string what)
    : title_(std::move(what)),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      next_(start_) {}

ProgressBar::~ProgressBar() {
  if (is_terminal_) std::fputs(kClearLine, stderr);
}

void ProgressBar::show(double fraction, const std::string& note) {
  const auto now = std::chrono::steady_clock::now();
  if (!is_terminal_ || now < next_) return;
  next_ = now + kBetweenUpdates;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "%s%s %s %.0f s %s", kClearLine, title_.c_str(),
               bar_text(fraction, kWidth).c_str(), elapsed_s, note.c_str());
  std::fflush(stderr);
}

void ProgressBar::say(const std::string& line) {
  std::fprintf(stderr, "%s%s\n", is_terminal_ ? kClearLine : "", line.c_str());
}

std::string bar_text(double fraction, int width) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  const auto filled = static_cast<std::size_t>(fraction * width);
  std::string bar(filled, '=');
  bar.resize(static_cast<std::size_t>(width), ' ');
  if (filled < bar.size()) bar[filled] = '>';
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * fraction);
  return "[" + bar + "] " + percent;
}

}  // namespace slammot
