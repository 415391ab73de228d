#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/files/result.hpp"
#include "services/keys/permissions.hpp"

namespace slammot::keys {

/// A certificate authority and what it issued. Computers get all files of the folder but those of
/// `ca/`; of the private keys (NAME.key.pem) only those of the services that they run.
class KeyFolder {
 public:
  struct Identity {
    std::string name;
    std::string until;  ///< Last day, as "2027-11-26".
    bool is_revoked = false;
    bool is_expired = false;
  };

  explicit KeyFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Makes the authority, the governance that it signs, and an empty list of revoked certificates.
  /// Refuses to replace an authority.
  std::optional<files::Error> init(int days) const;

  /// Makes key, certificate and signed permissions of an identity, valid from yesterday, since
  /// clocks differ. Replaces those it had; their certificate stays valid unless revoked.
  std::optional<files::Error> issue(const std::string& identity, const Grant& grant,
                                    int days) const;

  /// Puts the identity's certificate on the list of revoked ones (crl.pem). Refuses a name that was
  /// not issued.
  std::optional<files::Error> revoke(const std::string& identity) const;

  /// All that were issued, the oldest first.
  files::Result<std::vector<Identity>> identities() const;

 private:
  std::filesystem::path index() const { return folder_ / "ca" / "index.txt"; }
  std::optional<files::Error> find_lack_of_authority() const;
  std::optional<files::Error> run(std::vector<std::string> arguments) const;
  std::optional<files::Error> sign(const std::string& name, const std::string& xml) const;
  std::optional<files::Error> write_revoked() const;

  std::filesystem::path folder_;
};

}  // namespace slammot::keys
