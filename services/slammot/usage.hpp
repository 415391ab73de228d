#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace slammot {

/// Message about the first unknown command or option among the words of a command line, with the
/// nearest known one. Nothing if all are known.
std::optional<std::string> unknown_word(const CLI::App& app, const std::vector<std::string>& words);

/// A fault of parsing in one line: the command, what is wrong, and what is expected.
std::string explain(const CLI::App& app, const CLI::ParseError& fault);

/// A word as a POSIX shell takes it: in quotes unless it has plain characters only.
std::string shell_word(const std::string& word);

/// Names of all options of a command, with their dashes.
std::vector<std::string> options_of(const CLI::App& command);

/// Names of the commands below a command.
std::vector<std::string> commands_of(const CLI::App& command);

}  // namespace slammot
