#include "services/slammot/completion_command.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "services/slammot/command_line.hpp"
#include "services/slammot/completion_script.hpp"

namespace slammot {

void add_completion_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("completion", "Print a script that completes words in a shell");
  const auto shell = std::make_shared<std::string>();
  command->add_option("shell", *shell, "Which one; bash: source <(slammot completion bash)")
      ->required()
      ->type_name("bash|zsh|fish")
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell, &app, &exit_code] {
    const std::vector<CommandWords> commands = words_of(app);
    const std::string script = *shell == "bash"  ? bash_script(commands)
                               : *shell == "zsh" ? zsh_script(commands)
                                                 : fish_script(commands);
    exit_code = std::fputs(script.c_str(), stdout) < 0 ? kExitFault : kExitDone;
  });
}

}  // namespace slammot
