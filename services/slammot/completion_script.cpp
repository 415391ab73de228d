#include "services/slammot/completion_script.hpp"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>

namespace slammot {
namespace {

ValueKind kind_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (option.get_items_expected_max() == 0) return ValueKind::kNone;
  if (option.get_name() == "--scenario") return ValueKind::kScenario;
  if (type == "DIR") return ValueKind::kFolder;
  if (type.find("FILE") != std::string::npos || type == "PREFIX") return ValueKind::kFile;
  return ValueKind::kOther;
}

/// The first clause, without characters that a shell would take as its own.
std::string brief(const std::string& description) {
  std::string text = description.substr(0, description.find_first_of(";:("));
  std::erase_if(text, [](char letter) {
    return std::string_view("'\"`$\\[]").find(letter) != std::string_view::npos;
  });
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

void add_words(const CLI::App& app, std::vector<std::string> path,
               std::vector<CommandWords>& commands) {
  CommandWords words{std::move(path), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames())
      words.options.push_back({"--" + name, brief(option->get_description()), kind_of(*option)});
  }
  const auto parts = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* part : parts)
    words.parts.push_back({part->get_name(), brief(part->get_description())});
  commands.push_back(words);
  for (const CLI::App* part : parts) {
    std::vector<std::string> below = words.path;
    below.push_back(part->get_name());
    add_words(*part, std::move(below), commands);
  }
}

/// " map merge"; empty for the program itself.
std::string joined(const std::vector<std::string>& path) {
  std::string text;
  for (const std::string& word : path) text += " " + word;
  return text;
}

std::string names(const CommandWords& command, ValueKind kind) {
  std::string text;
  for (const OptionWords& option : command.options)
    if (option.value == kind) text += (text.empty() ? "" : " ") + option.name;
  return text;
}

std::string known_paths(const std::vector<CommandWords>& commands) {
  std::string text;
  for (const CommandWords& command : commands) {
    if (command.path.empty()) continue;
    text += (text.empty() ? "'" : " | '") + joined(command.path) + "'";
  }
  return text;
}

constexpr const char* kScenarios = "slammot simulate --list 2>/dev/null | cut -d ' ' -f 1";

}  // namespace

std::vector<CommandWords> words_of(const CLI::App& app) {
  std::vector<CommandWords> commands;
  add_words(app, {}, commands);
  return commands;
}

std::string bash_script(const std::vector<CommandWords>& commands) {
  std::string script =
      "# Completion of slammot for bash, printed by: slammot completion bash\n"
      "_slammot() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command='' i\n"
      "  local parts='' options='' files='' folders='' scenarios='' others=''\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"$command ${COMP_WORDS[i]}\" in\n      " +
      known_paths(commands) +
      ") command+=\" ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n  case $command in\n";
  for (const CommandWords& command : commands) {
    script += "    '" + joined(command.path) + "')\n      parts='";
    for (const PartWords& part : command.parts)
      script += (&part == &command.parts.front() ? "" : " ") + part.name;
    script += "'\n      options='";
    for (const OptionWords& option : command.options)
      script += (&option == &command.options.front() ? "" : " ") + option.name;
    script += "'\n      files='" + names(command, ValueKind::kFile) + "' folders='" +
              names(command, ValueKind::kFolder) + "' scenarios='" +
              names(command, ValueKind::kScenario) + "' others='" +
              names(command, ValueKind::kOther) + "'\n      ;;\n";
  }
  script +=
      "  esac\n"
      "  COMPREPLY=()\n"
      "  if [[ \" $files \" == *\" $before \"* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
      "  elif [[ \" $folders \" == *\" $before \"* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -d -- \"$word\")\n"
      "  elif [[ \" $scenarios \" == *\" $before \"* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$(";
  script += kScenarios;
  script +=
      ")\" -- \"$word\")\n"
      "  elif [[ \" $others \" == *\" $before \"* ]]; then\n"
      "    return\n"
      "  elif [[ $word == -* ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$word\")\n"
      "  elif [[ -n $parts ]]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$parts\" -- \"$word\")\n"
      "  else\n"
      "    mapfile -t COMPREPLY < <(compgen -f -- \"$word\")\n"
      "  fi\n"
      "}\n"
      "complete -o filenames -F _slammot slammot\n";
  return script;
}

std::string zsh_script(const std::vector<CommandWords>& commands) {
  std::string script =
      "#compdef slammot\n"
      "# Completion of slammot for zsh, printed by: slammot completion zsh\n"
      "_slammot() {\n"
      "  local command='' word before=${words[CURRENT - 1]}\n"
      "  local -a parts options files folders scenarios others\n"
      "  for word in ${words[2,CURRENT - 1]}; do\n"
      "    case \"$command $word\" in\n      " +
      known_paths(commands) + ") command+=\" $word\" ;;\n    esac\n  done\n  case $command in\n";
  for (const CommandWords& command : commands) {
    script += "    '" + joined(command.path) + "')\n      parts=(";
    for (const PartWords& part : command.parts) script += "'" + part.name + ":" + part.about + "' ";
    script += ")\n      options=(";
    for (const OptionWords& option : command.options)
      script += "'" + option.name + ":" + option.about + "' ";
    script += ")\n      files=(" + names(command, ValueKind::kFile) + ") folders=(" +
              names(command, ValueKind::kFolder) + ") scenarios=(" +
              names(command, ValueKind::kScenario) + ") others=(" +
              names(command, ValueKind::kOther) + ")\n      ;;\n";
  }
  script +=
      "  esac\n"
      "  if (( ${files[(Ie)$before]} )); then _files\n"
      "  elif (( ${folders[(Ie)$before]} )); then _files -/\n"
      "  elif (( ${scenarios[(Ie)$before]} )); then compadd -- ${(f)\"$(";
  script += kScenarios;
  script +=
      ")\"}\n"
      "  elif (( ${others[(Ie)$before]} )); then return 1\n"
      "  elif [[ $words[CURRENT] == -* ]]; then _describe option options\n"
      "  elif (( $#parts )); then _describe command parts\n"
      "  else _files\n"
      "  fi\n"
      "}\n"
      "if [[ $funcstack[1] == _slammot ]]; then _slammot \"$@\"; else compdef _slammot slammot; "
      "fi\n";
  return script;
}

std::string fish_script(const std::vector<CommandWords>& commands) {
  std::string script = "# Completion of slammot for fish, printed by: slammot completion fish\n";
  for (const CommandWords& command : commands) {
    std::string condition;
    for (const std::string& word : command.path)
      condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
    if (condition.empty()) condition = "__fish_use_subcommand";
    const std::string begin = "complete -c slammot -n '" + condition + "'";
    for (const PartWords& part : command.parts)
      script += begin + " -f -a " + part.name + " -d '" + part.about + "'\n";
    for (const OptionWords& option : command.options) {
      script += begin + " -l " + option.name.substr(2) + " -d '" + option.about + "'";
      if (option.value == ValueKind::kFile) script += " -r -F";
      if (option.value == ValueKind::kFolder) script += " -x -a '(__fish_complete_directories)'";
      if (option.value == ValueKind::kScenario)
        script +=
            std::string(" -x -a '(") + "slammot simulate --list | string split -f 1 \" \"" + ")'";
      if (option.value == ValueKind::kOther) script += " -x";
      script += "\n";
    }
  }
  return script;
}

}  // namespace slammot
