#include "common/config/explain.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <type_traits>
#include <utility>

#include "common/config/print.hpp"

namespace slammot::config {
namespace {

struct Suffix {
  std::string_view suffix;
  std::string_view unit;
};

/// The first that a name ends in says its unit, so the longer ones come first.
constexpr Suffix kSuffixes[] = {{"_m_per_sqrt_m", "m per sqrt(m)"},
                                {"_rad_per_sqrt_m", "rad per sqrt(m)"},
                                {"_m_per_sqrt_s", "m per sqrt(s)"},
                                {"_rad_per_sqrt_s", "rad per sqrt(s)"},
                                {"noise_per_m", "m/m"},
                                {"within_per_m", "m/m"},
                                {"_per_rad", "rad/rad"},
                                {"_per_m", "1/m"},
                                {"_per_s", "1/s"},
                                {"_radps2", "rad/s^2"},
                                {"_mps2", "m/s^2"},
                                {"_radps", "rad/s"},
                                {"_mps", "m/s"},
                                {"_log_odds", "nats"},
                                {"_score", "nats"},
                                {"_rad", "rad"},
                                {"_mb", "MB"},
                                {"_m", "m"},
                                {"_s", "s"}};

std::string kind_of(const Value& value) {
  return std::visit(
      [](const auto& held) -> std::string {
        using Held = std::remove_cvref_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, bool*>) return "yes or no";
        if constexpr (std::is_same_v<Held, std::string*>) return "text";
        if constexpr (std::is_same_v<Held, Choice>) return "name";
        if constexpr (std::is_same_v<Held, List>) return "list";
        return "";
      },
      value);
}

std::string title_of(const BoundField& field, std::string_view stage) {
  return field.group == Group::none
             ? std::string(stage)
             : std::string(name_of(field.group)) + ": " + std::string(description_of(field.group));
}

Explanation explain(const BoundStage& stage, const BoundField& field) {
  const bool is_number = number_in(field).has_value();
  return {std::string(stage.stage) + "." + field.name,
          title_of(field, stage.stage),
          unit_of(field),
          is_number ? range_in_words(field.range) : "",
          print_value(stage, field),
          std::string(field.meaning),
          std::string(field.consequences.too_small),
          std::string(field.consequences.too_large)};
}

std::string group_name(const Explanation& setting) {
  return setting.group.substr(0, setting.group.find(':'));
}

std::string with_commas(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
  }
  return text;
}

std::string with_title(const std::string& title, const std::string& text) {
  return text.empty() ? "" : title + text;
}

/// A bar would end the table's cell.
std::string in_cell(std::string text) {
  for (std::size_t bar = text.find('|'); bar != std::string::npos; bar = text.find('|', bar + 2))
    text.replace(bar, 1, "\\|");
  return text;
}

/// The text of each setting, with the title of a group wherever one begins.
template <class Titled, class Line>
std::string by_group(std::span<const Explanation> settings, Titled titled, Line line) {
  std::string text;
  std::string_view group;
  for (const Explanation& setting : settings) {
    if (setting.group != group) text += titled(setting.group, text.empty());
    text += line(setting);
    group = setting.group;
  }
  return text;
}

}  // namespace

std::string unit_of(const BoundField& field) {
  if (std::string kind = kind_of(field.value); !kind.empty()) return kind;
  const std::size_t open = field.meaning.find('[');
  const std::size_t close = field.meaning.find(']');
  if (open != std::string_view::npos && close != std::string_view::npos && open < close)
    return std::string(field.meaning.substr(open + 1, close - open - 1));
  const auto suffix = std::ranges::find_if(
      kSuffixes, [&](const Suffix& known) { return field.name.ends_with(known.suffix); });
  return suffix == std::end(kSuffixes) ? "" : std::string(suffix->unit);
}

std::vector<Explanation> explain(std::span<const BoundStage> stages) {
  std::vector<std::pair<Group, Explanation>> settings;
  for (const BoundStage& stage : stages) {
    for (const BoundField& field : stage.fields)
      settings.emplace_back(field.group, explain(stage, field));
  }
  std::ranges::stable_sort(settings, {}, &std::pair<Group, Explanation>::first);
  std::vector<Explanation> sorted;
  for (auto& [group, setting] : settings) sorted.push_back(std::move(setting));
  return sorted;
}

std::vector<Explanation> named(std::string_view word, std::span<const Explanation> settings) {
  std::vector<Explanation> found;
  const std::string inside = std::string(word) + ".";
  const std::string end = std::string(".").append(word);
  std::ranges::copy_if(settings, std::back_inserter(found), [&](const Explanation& setting) {
    return setting.name == word || setting.name.ends_with(end) ||
           setting.name.starts_with(inside) ||
           setting.name.find("." + inside) != std::string::npos || group_name(setting) == word;
  });
  return found;
}

std::string explanation_text(std::span<const Explanation> settings) {
  return by_group(
      settings,
      [](const std::string& title, bool is_first) { return (is_first ? "" : "\n") + title + "\n"; },
      [](const Explanation& setting) {
        return "\n  " + setting.name + "  (" +
               with_commas({setting.unit, setting.range, "default " + setting.value}) + ")\n" +  //
               "      " + setting.meaning + "\n" +
               with_title("      Too small: ", setting.too_small) +
               (setting.too_small.empty() ? "" : "\n") +
               with_title("      Too large: ", setting.too_large) +
               (setting.too_large.empty() ? "" : "\n");
      });
}

std::string explanation_lines(std::span<const Explanation> settings) {
  return by_group(
      settings,
      [](const std::string& title, bool is_first) { return (is_first ? "" : "\n") + title + "\n"; },
      [](const Explanation& setting) {
        return "  " + setting.name + " = " + setting.value + "  " + setting.meaning + "\n";
      });
}

std::string explanation_tables(std::span<const Explanation> settings) {
  return by_group(
      settings,
      [](const std::string& title, bool is_first) {
        return std::string(is_first ? "" : "\n") + "## " + title +
               "\n\n| setting | unit | range | default | what it is | too small | too large "
               "|\n|---|---|---|---|---|---|---|\n";
      },
      [](const Explanation& setting) {
        std::string row = "|";
        for (const std::string& cell :
             {"`" + setting.name + "`", setting.unit, setting.range, "`" + setting.value + "`",
              setting.meaning, setting.too_small, setting.too_large}) {
          row.append(" ").append(in_cell(cell)).append(" |");
        }
        return row + "\n";
      });
}

}  // namespace slammot::config
