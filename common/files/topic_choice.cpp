#include "common/files/topic_choice.hpp"

#include <algorithm>
#include <array>
#include <charconv>
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

Result<VerticalScanner> parse_vertical_scanner(const std::string& text) {
  const Error fault{"--vertical " + text +
                    ": not of the form NAME=AHEAD,LEFT,UP,ROLL,PITCH,HEADING [m, degrees]"};
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) return fault;
  std::array<double, 6> value{};
  const char* at = text.data() + equals;
  const char* const end = text.data() + text.size();
  for (double& number : value) {
    if (at == end) return fault;
    const auto [next, code] = std::from_chars(at + 1, end, number);
    const bool is_last = &number == &value.back();
    if (code != std::errc() || !std::isfinite(number) || (is_last ? next != end : *next != ','))
      return fault;
    at = next;
  }
  constexpr double kRadPerDeg = std::numbers::pi / 180.0;
  VerticalScanner scanner{
      text, text.substr(0, equals),
      sensing::in_space({value[0], value[1], value[5] * kRadPerDeg},
                        {value[2], value[3] * kRadPerDeg, value[4] * kRadPerDeg})};
  if (!sensing::scans_vertically(scanner.mounting))
    return Error{"--vertical " + text + ": with this roll and pitch it scans the plane"};
  return scanner;
}

std::string describe(const TopicChoice& choice) {
  std::string lines = lines_of("scanner:  ", "--scan-topic", choice.scanners) +
                      lines_of("odometry: ", "--odom-topic", choice.odometry);
  for (const std::string& note : choice.notes) lines += "          " + note + "\n";
  return lines;
}

}  // namespace slammot::files
