#include "common/config/nearest.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace slammot::config {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t kLettersToADifference = 3;
  const auto name = std::ranges::min_element(
      known, {}, [&](const std::string& one) { return edit_distance(word, one); });
  if (name == known.end() ||
      kLettersToADifference * edit_distance(word, *name) > std::max(word.size(), name->size()))
    return std::nullopt;
  return *name;
}

std::string hint_at_nearest(std::string_view word, const std::vector<std::string>& known) {
  const std::optional<std::string> name = nearest(word, known);
  return name ? "; the nearest one is '" + *name + "'" : "";
}

}  // namespace slammot::config
