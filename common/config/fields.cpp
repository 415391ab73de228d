#include "common/config/fields.hpp"

#include <sstream>
#include <type_traits>

namespace slammot::config {
namespace {

std::string in_words(const Range& range) {
  std::ostringstream words;
  if (range.highest == std::numeric_limits<double>::max()) {
    if (range.lowest == kPositive.lowest) return "not above 0";
    if (range.lowest == std::numeric_limits<double>::lowest()) return "not a finite number";
    words << "below " << range.lowest;
    return words.str();
  }
  words << "outside [" << range.lowest << ", " << range.highest << "]";
  return words.str();
}

}  // namespace

std::optional<double> number_in(const BoundField& field) {
  return std::visit(
      [](const auto& value) -> std::optional<double> {
        if constexpr (std::is_pointer_v<std::remove_cvref_t<decltype(value)>>) {
          using Type = std::remove_cvref_t<decltype(*value)>;
          if constexpr (!std::is_same_v<Type, bool> && !std::is_same_v<Type, std::string>) return static_cast<double>(*value);
        }
        return std::nullopt;
      },
      field.value);
}

std::optional<std::string> find_fault(const BoundField& field) {
  const std::optional<double> number = number_in(field);
  if (!number) return std::nullopt;
  const bool inside = *number >= field.range.lowest && *number <= field.range.highest;  // false for NaN
  if (inside) return std::nullopt;
  std::ostringstream fault;
  fault << field.name << " = " << *number << " is " << in_words(field.range) << ": " << field.meaning;
  return fault.str();
}

std::optional<std::string> find_fault(const BoundStage& stage) {
  for (const BoundField& field : stage.fields) {
    if (const auto fault = find_fault(field)) return std::string(stage.stage) + "." + *fault;
  }
  return std::nullopt;
}

}  // namespace slammot::config
