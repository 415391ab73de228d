#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slammot::keys {

/// What the holder of an identity may do on the bus.
struct Grant {
  std::string subject;  ///< Common name of its certificate.
  std::vector<std::string> publishes;
  std::vector<std::string> subscribes;  ///< Topic names; '*' stands for any text.
};

/// A time span in UTC, as "2026-11-26T00:00:00".
struct Validity {
  std::string from;
  std::string until;
};

/// The command line's identity: it may send commands.
inline constexpr std::string_view kTools = "tools";

/// Names of all identities of the project, as units name services: "map-store".
std::vector<std::string> project_identities();

/// Grant of one of project_identities(): publishes what the topic table says, subscribes to
/// everything of the project.
Grant grant_of(const std::string& identity);

/// Common name of an identity's certificate.
std::string subject_of(const std::string& identity);

/// DDS Security 1.1, 9.4.1.2: who is not authenticated takes no part, topics are encrypted, and
/// permissions decide who reads and writes.
std::string governance_xml();

/// DDS Security 1.1, 9.4.1.3: everything that is not granted is denied.
std::string permissions_xml(const Grant& grant, const Validity& validity);

}  // namespace slammot::keys
