#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace slammot {

/// What follows an option.
enum class ValueKind { kNone, kFile, kFolder, kScenario, kOther };

struct OptionWords {
  std::string name;  ///< "--input"
  std::string about;
  ValueKind value = ValueKind::kNone;
};

struct PartWords {
  std::string name;
  std::string about;
};

/// The words that may follow a command.
struct CommandWords {
  std::vector<std::string> path;  ///< {"map", "merge"}; empty for the program itself.
  std::vector<PartWords> parts;   ///< Commands below it.
  std::vector<OptionWords> options;
};

/// Of the program and of all commands below it.
std::vector<CommandWords> words_of(const CLI::App& app);

/// Scripts for shells, with the words as they are now. Names of scenarios are asked of the program
/// when they are needed; files and folders are completed by the shell.
std::string bash_script(const std::vector<CommandWords>& commands);
std::string zsh_script(const std::vector<CommandWords>& commands);
std::string fish_script(const std::vector<CommandWords>& commands);

}  // namespace slammot
