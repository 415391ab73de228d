#include "services/slammot/config_command.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/config/explain.hpp"
#include "common/config/nearest.hpp"
#include "common/config/print.hpp"
#include "common/config/profiles.hpp"
#include "common/files/failure.hpp"
#include "services/slammot/command_line.hpp"
#include "services/slammot/profile.hpp"

namespace slammot {
namespace {

constexpr const char* kPageTitle =
    "# Settings\n\n"
    "Written by `slammot config --page`: change the field tables (`services/*/*_fields.cpp`) and "
    "write it again. A file for `--config`\n"
    "sets them in protobuf's text format, `localization { map { cell_size_m: 0.1 } }`. Defaults "
    "are for road vehicles;\n"
    "`slammot config --effective --profile indoor` prints those of another. Every folder of "
    "results holds the settings of its run,\n"
    "`settings.textproto`, which `--config` reads back.\n\n";

struct ConfigOptions {
  bool explains = false;
  std::string word;  ///< Setting or group to explain; empty: all.
  bool is_effective = false;
  bool is_page = false;
  std::string profile;
  std::filesystem::path config;
};

std::vector<config::Explanation> default_settings() {
  Profile defaults;
  return config::explain(bind_stages(defaults));
}

/// Names that a user may have meant: full ones if `word` has a dot, otherwise their last parts.
std::vector<std::string> names_like(const std::string& word,
                                    const std::vector<config::Explanation>& settings) {
  std::vector<std::string> names;
  const bool is_path = word.find('.') != std::string::npos;
  for (const config::Explanation& setting : settings)
    names.push_back(is_path ? setting.name : setting.name.substr(setting.name.rfind('.') + 1));
  return names;
}

int explain(const std::string& word) {
  const std::vector<config::Explanation> all = default_settings();
  const std::vector<config::Explanation> requested = word.empty() ? all : config::named(word, all);
  if (requested.empty())
    return files::refuse("no setting or group is called '" + word + "'" +
                         config::hint_at_nearest(word, names_like(word, all)) +
                         "; slammot config --explain lists all");
  std::fputs(config::explanation_text(requested).c_str(), stdout);
  return kExitDone;
}

int print_effective(const ConfigOptions& options) {
  if (!options.profile.empty() && !config::find_profile(options.profile))
    return files::refuse(config::unknown_profile(options.profile));
  Profile profile;
  if (const auto fault = load_settings(options.profile, options.config, profile))
    return files::fail(*fault);
  std::fputs(config::print(bind_stages(profile)).c_str(), stdout);
  return kExitDone;
}

int print_page() {
  std::fputs((kPageTitle + config::explanation_tables(default_settings())).c_str(), stdout);
  return kExitDone;
}

int show(const ConfigOptions& options) {
  if (int(options.explains) + int(options.is_effective) + int(options.is_page) != 1)
    return files::refuse("config requires one of --explain, --effective and --page");
  if (!options.is_effective && (!options.profile.empty() || !options.config.empty()))
    return files::refuse("--profile and --config belong to --effective");
  if (options.is_effective) return print_effective(options);
  return options.is_page ? print_page() : explain(options.word);
}

}  // namespace

void add_config_command(CLI::App& app, int& exit_code) {
  CLI::App* const command =
      app.add_subcommand("config", "Explain the settings, or print those that a run would use");
  const auto options = std::make_shared<ConfigOptions>();
  const CLI::Option* const explains =
      command
          ->add_option("--explain", options->word,
                       "Meaning, unit, range and default of all settings, of one, or of a group")
          ->type_name("NAME")
          ->expected(0, 1);
  command->add_flag("--effective", options->is_effective,
                    "Print all settings as a file for --config");
  command
      ->add_option("--profile", options->profile,
                   "Profile for --effective; default: none, the built-in settings")
      ->type_name("NAME");
  command->add_option("--config", options->config, "Settings that override the profile's")
      ->type_name("FILE");
  command->add_flag("--page", options->is_page,
                    "Print the page of the documentation, docs/settings.md");
  command->footer([] { return "Settings:\n" + config::explanation_lines(default_settings()); });
  command->callback([options, explains, &exit_code] {
    options->explains = explains->count() > 0;
    exit_code = show(*options);
  });
}

}  // namespace slammot
