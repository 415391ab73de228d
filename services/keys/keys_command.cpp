#include "services/keys/keys_command.hpp"

#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "common/files/failure.hpp"
#include "services/keys/key_folder.hpp"

namespace slammot::keys {
namespace {

struct Options {
  std::string folder;
  std::vector<std::string> names;
  std::vector<std::string> publishes, subscribes;
  int authority_days = 3650;
  int identity_days = 365;
};

int report(const std::optional<files::Error>& fault) { return fault ? files::fail(*fault) : 0; }

/// Names become names of files and parts of certificates.
std::string fault_of_name(const std::string& name) {
  const bool is_plain =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
  if (name.empty() || name.size() > 40 || name.front() == '-' || !is_plain)
    return "'" + name + "' is not 1 to 40 small letters, digits, '-'";
  return {};
}

/// What a name means: a service of the project, or what the options say.
files::Result<Grant> grant_for(const std::string& name, const Options& options) {
  const auto known = project_identities();
  const bool is_known = std::find(known.begin(), known.end(), name) != known.end();
  const bool is_told = !options.publishes.empty() || !options.subscribes.empty();
  if (is_told) return Grant{subject_of(name), options.publishes, options.subscribes};
  if (is_known) return grant_of(name);
  return files::Error{name + " is no service: say what it may --publish and --subscribe to"};
}

int issue(const Options& options) {
  const KeyFolder keys(options.folder);
  for (const std::string& name : options.names.empty() ? project_identities() : options.names) {
    auto grant = grant_for(name, options);
    if (!grant) return report(grant.error());
    if (const auto fault = keys.issue(name, *grant, options.identity_days)) return report(fault);
    std::printf("%s may publish", name.c_str());
    for (const std::string& topic : grant->publishes) std::printf(" %s", topic.c_str());
    std::printf("%s\n", grant->publishes.empty() ? " nothing" : "");
  }
  return 0;
}

int revoke(const Options& options) {
  const KeyFolder keys(options.folder);
  for (const std::string& name : options.names) {
    if (const auto fault = keys.revoke(name)) return report(fault);
    std::printf("%s is revoked: copy crl.pem to all computers and restart their services\n",
                name.c_str());
  }
  return 0;
}

int list(const Options& options) {
  auto identities = KeyFolder(options.folder).identities();
  if (!identities) return report(identities.error());
  for (const auto& [name, until, is_revoked, is_expired] : *identities) {
    const char* const state = is_revoked ? "revoked" : is_expired ? "expired" : "valid";
    std::printf("%-20s until %s  %s\n", name.c_str(), until.c_str(), state);
  }
  return 0;
}

CLI::App* add(CLI::App& keys, const char* name, const char* purpose,
              const std::shared_ptr<Options>& options) {
  CLI::App* const command = keys.add_subcommand(name, purpose);
  command->add_option("folder", options->folder, "Folder of the authority")->required();
  return command;
}

CLI::Option* add_days(CLI::App& command, int& days) {
  return command.add_option("--days", days, "Validity [days]")
      ->check(CLI::Range(1, 7300))
      ->capture_default_str();
}

}  // namespace

void add_keys_command(CLI::App& app, int& exit_code) {
  CLI::App* const keys = app.add_subcommand("keys", "Make keys and permissions for a secured bus");
  keys->require_subcommand(1);
  const auto options = std::make_shared<Options>();
  const CLI::Validator is_name(fault_of_name, "NAME");

  CLI::App* const init_command = add(*keys, "init", "Make a development authority", options);
  add_days(*init_command, options->authority_days);
  init_command->callback([options, &exit_code] {
    exit_code = report(KeyFolder(options->folder).init(options->authority_days));
  });

  CLI::App* const issue_command = add(*keys, "issue", "Make identities", options);
  issue_command->add_option("names", options->names, "Default: all services, and tools")
      ->check(is_name);
  issue_command->add_option("--publish", options->publishes, "Topics; default: by the service");
  issue_command->add_option("--subscribe", options->subscribes, "Topics; default: slammot/*");
  add_days(*issue_command, options->identity_days);
  issue_command->callback([options, &exit_code] { exit_code = issue(*options); });

  CLI::App* const revoke_command = add(*keys, "revoke", "Revoke identities", options);
  revoke_command->add_option("names", options->names)->required()->check(is_name);
  revoke_command->callback([options, &exit_code] { exit_code = revoke(*options); });

  CLI::App* const list_command = add(*keys, "list", "List what was issued", options);
  list_command->callback([options, &exit_code] { exit_code = list(*options); });
}

}  // namespace slammot::keys
