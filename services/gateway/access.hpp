#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace slammot::gateway {

/// Who may connect.
struct AccessRules {
  std::string token;                           ///< Asked of remote addresses; empty: none may come.
  std::vector<std::string> trusted_addresses;  ///< Need no token, as loopback addresses.
  std::vector<std::string> origins;            ///< Pages of other servers that may connect.
  std::vector<std::string> host_names;         ///< Names of this machine besides localhost.
};

/// Pages and programs of viewers, which any user of Foxglove or Lichtblick opens.
std::vector<std::string> origins_of_viewers();

/// What a request says about who sends it.
struct Caller {
  std::string address;       ///< Of the peer, "127.0.0.1".
  bool is_loopback = false;  ///< Of the peer's address.
  std::string_view host;     ///< Header Host.
  std::string_view origin;   ///< Header Origin; empty if there is none.
  std::string_view token;    ///< From the query or the header Authorization.
};

enum class Verdict : std::uint8_t { kAllowed, kNeedsToken, kForeignOrigin, kForeignHost };

/// A page may connect if it came from this server or is listed. Without a token the header Host
/// must name this machine or be an address: a foreign name that resolves to this machine (DNS
/// rebinding) would make a foreign page look like one of this server.
Verdict verdict_on(const Caller& caller, const AccessRules& rules);

std::string_view explanation_of(Verdict verdict);

/// The value of `name` in "a=1&b=2", decoded (RFC 3986, section 2.1; '+' stands for itself); empty
/// if there is none.
std::string query_value(std::string_view query, std::string_view name);

/// The token of a header Authorization of the scheme Bearer, in any case (RFC 9110, section 11.1);
/// empty if there is none.
std::string_view bearer_token(std::string_view authorization);

/// 128 bits from the operating system, in hexadecimal digits.
std::string new_token();

}  // namespace slammot::gateway
