#include "services/evaluator/page_theme.hpp"

#include <charconv>

#include "services/evaluator/report_player.hpp"

namespace slammot::evaluator {

PageTheme theme_in(std::string_view script, std::string_view name) {
  constexpr std::size_t kHexDigits = 6;
  PageTheme theme;
  const std::size_t begin = script.find(std::string(name) + ": all({");
  if (begin == std::string_view::npos) return theme;
  const std::string_view block = script.substr(begin, script.find("})", begin) - begin);
  for (std::size_t at = block.find(": \"#"); at != std::string_view::npos;
       at = block.find(": \"#", at + 1)) {
    const std::size_t before = block.find_last_of(" {\n", at - 1);
    unsigned value = 0;
    const std::string_view digits = block.substr(at + 4, kHexDigits);
    std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    theme[std::string(block.substr(before + 1, at - before - 1))] = {
        static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 255U),
        static_cast<std::uint8_t>(value & 255U)};
  }
  return theme;
}

PageTheme page_theme(std::string_view name) { return theme_in(page_file("theme.js"), name); }

std::string colour_name_of(std::string_view object_class) {
  if (object_class == "truck_or_bus") return "truck";
  return object_class == "unknown" ? "other" : std::string(object_class);
}

}  // namespace slammot::evaluator
