#include "services/inspector/table_text.hpp"

#include <algorithm>

namespace slammot::inspector {
namespace {

std::string padded(const std::string& text, std::size_t width, bool is_right) {
  const std::string space(width - std::min(width, text.size()), ' ');
  return is_right ? space + text : text + space;
}

}  // namespace

std::string table_text(const std::vector<std::string>& titles,
                       const std::vector<std::vector<std::string>>& rows, std::size_t right_from) {
  std::vector<std::size_t> widths(titles.size(), 0);
  const auto widen = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  };
  widen(titles);
  for (const auto& row : rows) widen(row);
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i)
      line += (i == 0 ? "" : "  ") + padded(row[i], widths[i], i >= right_from);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  };
  add(titles);
  for (const auto& row : rows) add(row);
  return text;
}

}  // namespace slammot::inspector
