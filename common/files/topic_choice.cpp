#include "common/files/topic_choice.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace slammot::files {
namespace {

std::string figures_of(const TopicCandidate& candidate) {
  char text[128];
  std::string figures =
      " (" + candidate.type + ", " + std::to_string(candidate.messages) + " messages";
  if (candidate.rate_hz > 0.0) {
    std::snprintf(text, sizeof text, ", %.1f Hz", candidate.rate_hz);
    figures += text;
  }
  if (candidate.beams > 0) {
    std::snprintf(text, sizeof text, ", %zu beams over %.0f degrees", candidate.beams,
                  std::floor(candidate.field_of_view_rad * 180.0 / std::numbers::pi + 0.25));
    figures += text;
  }
  if (!candidate.frame.empty()) figures += ", frame " + candidate.frame;
  if (!candidate.note.empty()) figures += ", " + candidate.note;
  return figures + ")";
}

std::string lines_of(const char* title, const char* option,
                     const std::vector<TopicCandidate>& candidates) {
  std::string lines;
  for (const TopicCandidate& candidate : candidates) {
    if (candidate.is_chosen) lines += title + candidate.topic + figures_of(candidate) + "\n";
  }
  for (const TopicCandidate& candidate : candidates) {
    if (!candidate.is_chosen)
      lines += "          not used: " + candidate.topic + figures_of(candidate) + "; " + option +
               " " + candidate.topic + " selects it\n";
  }
  return lines;
}

}  // namespace

std::string describe(const TopicChoice& choice) {
  std::string lines = lines_of("scanner:  ", "--scan-topic", choice.scanners) +
                      lines_of("odometry: ", "--odom-topic", choice.odometry);
  for (const std::string& note : choice.notes) lines += "          " + note + "\n";
  return lines;
}

}  // namespace slammot::files
