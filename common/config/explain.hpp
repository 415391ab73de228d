#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/fields.hpp"

namespace slammot::config {

/// A setting as listings show it.
struct Explanation {
  std::string name;   ///< "localization.map.cell_size_m"
  std::string group;  ///< Title of its group; the stage's name where the setting has none.
  std::string unit;   ///< "m", "rad/m"; "yes or no", "text" or "names" where it is no number; empty
                      ///< without one.
  std::string range;  ///< "0.02 to 1", "above 0"; empty where any value is accepted.
  std::string value;  ///< As the text format writes it.
  std::string meaning;
  std::string too_small;  ///< What goes wrong then; empty where the meaning says it.
  std::string too_large;
};

/// Every setting with the value that it has now, group by group. Precondition: tables and
/// slammot.proto agree.
std::vector<Explanation> explain(std::span<const BoundStage> stages);

/// Those that a word names: a whole name, its end ("cell_size_m"), its beginning
/// ("localization.map") or a group.
std::vector<Explanation> named(std::string_view word, std::span<const Explanation> settings);

/// For a terminal: some lines a setting under the title of its group.
std::string explanation_text(std::span<const Explanation> settings);

/// For --help: one line a setting.
std::string explanation_lines(std::span<const Explanation> settings);

/// For the documentation: a table a group, in Markdown.
std::string explanation_tables(std::span<const Explanation> settings);

/// Unit of a setting: what the meaning says in brackets, otherwise what the name ends in.
std::string unit_of(const BoundField& field);

}  // namespace slammot::config
