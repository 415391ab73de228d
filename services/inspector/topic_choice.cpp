#include "services/inspector/topic_choice.hpp"

#include <vector>

#include "common/config/nearest.hpp"

namespace slammot::inspector {

std::optional<std::string> topic_meant(const std::string& word,
                                       const std::set<std::string>& names) {
  for (const std::string& name : {word, "slammot/" + word}) {
    if (names.contains(name)) return name;
  }
  return std::nullopt;
}

std::string unknown_topic(const std::string& word, const std::set<std::string>& names) {
  if (names.empty()) return "no topic '" + word + "': nobody is on the bus";
  std::vector<std::string> known(names.begin(), names.end());
  for (const std::string& name : names) {
    if (name.starts_with("slammot/")) known.push_back(name.substr(8));
  }
  return "no topic '" + word + "' on the bus" + config::hint_at_nearest(word, known) +
         "; slammot list shows all";
}

}  // namespace slammot::inspector
