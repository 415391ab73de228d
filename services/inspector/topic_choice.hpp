#pragma once

#include <optional>
#include <set>
#include <string>

namespace slammot::inspector {

/// The topic that a user means: the name, or the name after "slammot/". None if there is none.
std::optional<std::string> topic_meant(const std::string& word, const std::set<std::string>& names);

/// "no topic 'x' on the bus; did you mean ...?"
std::string unknown_topic(const std::string& word, const std::set<std::string>& names);

}  // namespace slammot::inspector
