#include "services/keys/key_folder.hpp"

#include <chrono>
#include <ctime>
#include <fstream>
#include <sstream>

#include "common/app/system_clock.hpp"
#include "common/files/atomic_file.hpp"
#include "services/keys/openssl.hpp"

namespace slammot::keys {
namespace {

constexpr std::string_view kAuthority =
    "[ca]\n"
    "default_ca = slammot\n"
    "[slammot]\n"
    "database = ca/index.txt\n"
    "new_certs_dir = ca/issued\n"
    "certificate = ca.pem\n"
    "private_key = ca/ca.key.pem\n"
    "default_md = sha256\n"
    "rand_serial = yes\n"
    "unique_subject = no\n"
    "crlnumber = ca/crlnumber\n"
    "default_crl_days = 3650\n"
    "policy = names\n"
    "[names]\n"
    "commonName = supplied\n";
constexpr std::string_view kCurve = "ec_paramgen_curve:prime256v1";

std::string utc(int days_from_now, const char* format) {
  const std::time_t time = app::system_clock_ns() / 1'000'000'000 + days_from_now * 86'400L;
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  return {text, std::strftime(text, sizeof text, format, &parts)};
}

/// The first error of calls that follow each other.
template <typename... Steps>
std::optional<files::Error> in_order(const Steps&... steps) {
  std::optional<files::Error> fault;
  (void)((!(fault = steps())) && ...);
  return fault;
}

/// "R\t271126000000Z\t261126010203Z\tSERIAL\tunknown\t/CN=slammot-tracking", the format of
/// `openssl ca`.
KeyFolder::Identity identity_of(const std::string& line) {
  std::istringstream fields(line);
  std::string state, until, subject;
  std::getline(fields, state, '\t');
  std::getline(fields, until, '\t');
  subject = line.substr(line.rfind('=') + 1);
  const std::string prefix = subject_of("");
  if (subject.starts_with(prefix)) subject.erase(0, prefix.size());
  const bool is_expired = until < utc(0, "%y%m%d%H%M%SZ");
  if (until.size() >= 6)
    until = "20" + until.substr(0, 2) + "-" + until.substr(2, 2) + "-" + until.substr(4, 2);
  return {subject, until, state == "R", is_expired};
}

}  // namespace

std::optional<files::Error> KeyFolder::find_lack_of_authority() const {
  if (std::filesystem::exists(index())) return std::nullopt;
  return files::Error{folder_.string() + " has no authority: make one with slammot keys init " +
                      folder_.string()};
}

std::optional<files::Error> KeyFolder::run(std::vector<std::string> arguments) const {
  const auto output = openssl(folder_, std::move(arguments));
  return output ? std::nullopt : std::optional(output.error());
}

std::optional<files::Error> KeyFolder::sign(const std::string& name, const std::string& xml) const {
  const std::string source = "ca/" + name + ".xml";
  return in_order([&] { return files::write_file_atomically(folder_ / source, xml); },
                  [&] {
                    return run({"smime", "-sign", "-text", "-in", source, "-out", name + ".p7s",
                                "-signer", "ca.pem", "-inkey", "ca/ca.key.pem"});
                  });
}

std::optional<files::Error> KeyFolder::write_revoked() const {
  return run({"ca", "-config", "ca/openssl.cnf", "-gencrl", "-out", "crl.pem"});
}

std::optional<files::Error> KeyFolder::init(int days) const {
  const auto authority = folder_ / "ca";
  if (std::filesystem::exists(authority))
    return files::Error{folder_.string() + " has an authority already"};
  std::error_code fault;
  std::filesystem::create_directories(authority / "issued", fault);
  if (fault) return files::Error{"cannot make " + authority.string() + ": " + fault.message()};
  std::filesystem::permissions(authority, std::filesystem::perms::owner_all, fault);
  return in_order(
      [&] { return files::write_file_atomically(authority / "openssl.cnf", kAuthority); },
      [&] { return files::write_file_atomically(authority / "index.txt", ""); },
      [&] { return files::write_file_atomically(authority / "crlnumber", "01\n"); },
      [&] {
        return run({"req", "-x509", "-newkey", "ec", "-pkeyopt", std::string(kCurve), "-noenc",
                    "-keyout", "ca/ca.key.pem", "-out", "ca.pem", "-days", std::to_string(days),
                    "-subj", "/CN=slammot-authority"});
      },
      [&] { return write_revoked(); }, [&] { return sign("governance", governance_xml()); });
}

std::optional<files::Error> KeyFolder::issue(const std::string& identity, const Grant& grant,
                                             int days) const {
  const std::string request = "ca/" + identity + ".csr.pem";
  const Validity validity{utc(-1, "%Y-%m-%dT%H:%M:%S"), utc(days, "%Y-%m-%dT%H:%M:%S")};
  return in_order(
      [&] { return find_lack_of_authority(); },
      [&] {
        return run({"req", "-new", "-newkey", "ec", "-pkeyopt", std::string(kCurve), "-noenc",
                    "-keyout", identity + ".key.pem", "-out", request, "-subj",
                    "/CN=" + grant.subject});
      },
      [&] {
        return run({"ca", "-batch", "-notext", "-config", "ca/openssl.cnf", "-in", request, "-out",
                    identity + ".cert.pem", "-startdate", utc(-1, "%Y%m%d%H%M%SZ"), "-enddate",
                    utc(days, "%Y%m%d%H%M%SZ")});
      },
      [&] { return sign(identity + ".permissions", permissions_xml(grant, validity)); });
}

std::optional<files::Error> KeyFolder::revoke(const std::string& identity) const {
  const std::string certificate = identity + ".cert.pem";
  return in_order([&] { return find_lack_of_authority(); },
                  [&]() -> std::optional<files::Error> {
                    if (std::filesystem::exists(folder_ / certificate)) return std::nullopt;
                    return files::Error{(folder_ / certificate).string() +
                                        " is missing: slammot keys list " + folder_.string() +
                                        " names what was issued"};
                  },
                  [&] {
                    return run({"ca", "-config", "ca/openssl.cnf", "-revoke", certificate});
                  },
                  [&] { return write_revoked(); });
}

files::Result<std::vector<KeyFolder::Identity>> KeyFolder::identities() const {
  if (auto fault = find_lack_of_authority()) return std::move(*fault);
  std::ifstream lines(index());
  std::vector<Identity> identities;
  for (std::string line; std::getline(lines, line);) identities.push_back(identity_of(line));
  return identities;
}

}  // namespace slammot::keys
