#pragma once

#include <set>
#include <string>
#include <string_view>

namespace slammot::recorder {

/// Those of the topics to be played that a running service of this name publishes, too: readers
/// keep to one source of a topic. The heartbeat is among them for the services of a drive, which
/// would take a recorded process for their leader.
std::set<std::string> contested_topics(std::string_view service,
                                       const std::set<std::string>& played);

/// What to do about it, in one line.
std::string contest(std::string_view service, const std::string& vehicle_id,
                    const std::set<std::string>& topics);

}  // namespace slammot::recorder
