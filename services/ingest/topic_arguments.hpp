#pragma once

#include <string>
#include <vector>

#include "common/files/topic_choice.hpp"

namespace CLI {
class App;
}

namespace slammot::ingest {

/// Adds --scan-topic and the other options that select topics of a log.
void add_topic_options(CLI::App& command_line, files::TopicOptions& topics);

/// Adds --vertical alone.
void add_vertical_option(CLI::App& command_line, files::TopicOptions& topics);

/// The options as arguments for another process.
std::vector<std::string> arguments_of(const files::TopicOptions& topics);

}  // namespace slammot::ingest
