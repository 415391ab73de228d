#include "services/slammot/usage.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <CLI/CLI.hpp>

#include "common/config/nearest.hpp"

namespace slammot {
namespace {

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
  return std::ranges::find(words, word) != words.end();
}

/// False for "-", "--", and numbers.
bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word != "--" &&
         std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

std::string unknown_command(const std::string& word, const std::string& above,
                            const std::vector<std::string>& known) {
  return "unknown command '" + (above.empty() ? word : above + " " + word) + "'" +
         config::hint_at_nearest(word, known) + "; slammot " + (above.empty() ? "" : above + " ") +
         "--help lists all";
}

/// The commands that were named, outermost first; with the program itself.
std::vector<const CLI::App*> path_of(const CLI::App& app) {
  std::vector<const CLI::App*> path = {&app};
  for (auto named = app.get_subcommands(); !named.empty(); named = path.back()->get_subcommands())
    path.push_back(named.front());
  return path;
}

std::string name_of(const std::vector<const CLI::App*>& path) {
  std::string name;
  for (const CLI::App* command : path) name += (name.empty() ? "" : " ") + command->get_name();
  return name;
}

/// Positional arguments in capitals, as documents name them.
std::string shown_name(const CLI::Option& option) {
  std::string name = option.get_name();
  if (!name.starts_with("-"))
    std::ranges::transform(name, name.begin(), [](unsigned char letter) {
      return static_cast<char>(std::toupper(letter));
    });
  return name;
}

/// "DIR: folder for the results"
std::string meaning_of(const CLI::Option& option) {
  std::string type = option.get_type_name();
  type = type.substr(0, type.find(':'));  // Limits follow.
  if (type == "N") type = "a whole number";
  return (type.empty() ? "" : type + ": ") + option.get_description();
}

std::string missing_of(const CLI::App& command) {
  std::string missing;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    missing += (missing.empty() ? "" : "; ") + shown_name(*option) + " is missing (" +
               meaning_of(*option) + ")";
  }
  if (!missing.empty()) return missing;
  std::string commands;
  for (const std::string& name : commands_of(command))
    commands += (commands.empty() ? "" : ", ") + name;
  return commands.empty() ? std::string() : "a command is missing, one of: " + commands;
}

/// The option that a message of the parser begins with or names after a colon.
const CLI::Option* option_in(const CLI::App& command, const std::string& message) {
  const CLI::Option* found = nullptr;
  for (const CLI::Option* option : command.get_options()) {
    const std::string& name = option->get_name();
    const bool is_named =
        message.starts_with(name + ":") || message.find(": " + name + " =") != std::string::npos;
    if (is_named && (found == nullptr || name.size() > found->get_name().size())) found = option;
  }
  return found;
}

/// What a message of too few values says.
std::string lacking(const CLI::Option& option) {
  const int least = option.get_items_expected_min();
  if (option.count() == 0 || least < 2)
    return shown_name(option) + " lacks its value, " + meaning_of(option);
  return shown_name(option) + " takes at least " + std::to_string(least) + " values, not " +
         std::to_string(option.count()) + ", " + meaning_of(option);
}

std::string after_equals(const std::string& message) {
  const std::size_t at = message.find(" = ");
  return at == std::string::npos ? message : message.substr(at + 3);
}

}  // namespace

std::vector<std::string> commands_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* part : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(part->get_name());
  return names;
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

std::optional<std::string> unknown_word(const CLI::App& app,
                                        const std::vector<std::string>& words) {
  const CLI::App* command = &app;
  std::string name_of_command;
  auto word = words.begin();
  for (; word != words.end() && !is_option(*word); ++word) {
    const std::vector<std::string> parts = commands_of(*command);
    if (parts.empty()) break;
    if (!is_one_of(*word, parts)) return unknown_command(*word, name_of_command, parts);
    command = command->get_subcommand(*word);
    name_of_command += (name_of_command.empty() ? "" : " ") + *word;
  }
  const std::vector<std::string> options = options_of(*command);
  for (; word != words.end() && *word != "--"; ++word) {
    const std::string name = word->substr(0, word->find('='));
    if (!is_option(name) || is_one_of(name, options)) continue;
    return "unknown option '" + name + "'" +
           (name_of_command.empty() ? "" : " of " + name_of_command) +
           config::hint_at_nearest(name, options) + "; slammot " +
           (name_of_command.empty() ? "" : name_of_command + " ") + "--help lists all";
  }
  return std::nullopt;
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain = "%+,-./:=@_";
  const bool is_plain = !word.empty() && std::ranges::all_of(word, [&](char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 ||
           kPlain.find(letter) != std::string_view::npos;
  });
  if (is_plain) return word;
  std::string quoted = "'";
  for (const char letter : word) {
    if (letter == '\'') quoted += "'\\''";
    else quoted += letter;
  }
  return quoted + "'";
}

std::string explain(const CLI::App& app, const CLI::ParseError& fault) {
  const std::vector<const CLI::App*> path = path_of(app);
  const std::string command = name_of(path);
  const std::string message = fault.what();
  const CLI::Option* const option = option_in(*path.back(), message);
  std::string what = message;
  if (fault.get_name() == "RequiredError") {
    if (const std::string missing = missing_of(*path.back()); !missing.empty()) what = missing;
  } else if (option != nullptr && fault.get_name() == "ConversionError") {
    what = shown_name(*option) + " does not take '" + after_equals(message) + "', but " +
           meaning_of(*option);
  } else if (option != nullptr && fault.get_name() == "ArgumentMismatch") {
    what = lacking(*option);
  }
  return command + ": " + what + "; " + command + " --help explains";
}

}  // namespace slammot
