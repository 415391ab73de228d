#include "common/config/fields.hpp"

#include <array>
#include <sstream>
#include <type_traits>

namespace slammot::config {
namespace {

struct GroupWords {
  std::string_view name;
  std::string_view description;
};

/// In the order of Group.
constexpr std::array<GroupWords, 14> kGroups = {{
    {"sensor", "where a scanner is and what its ranges are worth"},
    {"odometry", "what wheels say of the motion from scan to scan"},
    {"map", "the local map and what it holds"},
    {"matching", "how a scan is matched against the map"},
    {"closing", "how a revisit is found and the graph corrected"},
    {"motion", "what moves, and how"},
    {"association", "which echoes belong to which track"},
    {"extent", "which echoes are one body, and how large it is"},
    {"existence", "when a track begins, is confirmed and ends"},
    {"publication", "what is published, and how sure it is said to be"},
    {"warning", "which predicted encounters are warned of"},
    {"operation", "the services at run time"},
    {"log", "set by what a recorded drive shows, to read a run's settings back"},
    {"", ""},
}};

bool has_highest(const Range& range) { return range.highest < kPositive.highest; }

/// What is wrong with a number outside the range.
std::string in_words(const Range& range, double number) {
  std::ostringstream words;
  if (has_highest(range) && range.lowest == kPositive.lowest)
    words << "outside (0, " << range.highest << "]";
  else if (has_highest(range)) words << "outside [" << range.lowest << ", " << range.highest << "]";
  else if (range.lowest == std::numeric_limits<double>::lowest()) words << "not a finite number";
  else if (number > range.highest) words << "above " << range.highest;
  else if (range.lowest == kPositive.lowest && !(number > 0.0)) words << "not above 0";
  else words << "below " << range.lowest;
  return words.str();
}

}  // namespace

std::string_view name_of(Group group) { return kGroups.at(static_cast<std::size_t>(group)).name; }

std::string_view description_of(Group group) {
  return kGroups.at(static_cast<std::size_t>(group)).description;
}

std::string range_in_words(const Range& range) {
  const bool has_lowest = range.lowest > std::numeric_limits<double>::lowest();
  std::ostringstream words;
  if (range.lowest == kPositive.lowest) {
    words << "above 0";
    if (has_highest(range)) words << " up to " << range.highest;
  } else if (has_lowest && has_highest(range)) {
    words << range.lowest << " to " << range.highest;
  } else if (has_lowest) {
    words << range.lowest << " or more";
  } else if (has_highest(range)) {
    words << range.highest << " or less";
  }
  return words.str();
}

std::optional<double> number_in(const BoundField& field) {
  return std::visit(
      [](const auto& value) -> std::optional<double> {
        if constexpr (std::is_pointer_v<std::remove_cvref_t<decltype(value)>>) {
          using Type = std::remove_cvref_t<decltype(*value)>;
          if constexpr (!std::is_same_v<Type, bool> && !std::is_same_v<Type, std::string>)
            return static_cast<double>(*value);
        }
        return std::nullopt;
      },
      field.value);
}

std::optional<std::string> find_fault(const BoundField& field) {
  const std::optional<double> number = number_in(field);
  if (!number) return std::nullopt;
  // false for NaN
  const bool inside = *number >= field.range.lowest && *number <= field.range.highest;
  if (inside) return std::nullopt;
  std::ostringstream fault;
  fault << field.name << " = " << *number << " is " << in_words(field.range, *number) << ": "
        << field.meaning;
  return fault.str();
}

std::optional<std::string> find_fault(const BoundStage& stage) {
  for (const BoundField& field : stage.fields) {
    if (const auto fault = find_fault(field)) return std::string(stage.stage) + "." + *fault;
  }
  return std::nullopt;
}

}  // namespace slammot::config
