#pragma once

#include <string>
#include <vector>

#include "common/files/topic_choice.hpp"

namespace CLI {
class App;
}

namespace slammot::ingest {

/// --scan-topic and its like: which topics of a log that leaves a choice are taken.
void add_topic_options(CLI::App& command_line, files::TopicOptions& topics);

/// The same options as arguments, for another process.
std::vector<std::string> arguments_of(const files::TopicOptions& topics);

}  // namespace slammot::ingest
