#include "services/gateway/access.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <random>

namespace slammot::gateway {
namespace {

bool contains(const std::vector<std::string>& list, std::string_view text) {
  return std::ranges::find(list, text) != list.end();
}

/// Takes as long for a wrong first letter as for a wrong last one.
bool are_equal_secrets(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// Host name without port.
std::string_view name_of_host(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

bool is_address(std::string_view name) {
  if (name.starts_with('[')) return name.ends_with(']');
  return !name.empty() && name.find_first_not_of("0123456789.") == std::string_view::npos;
}

bool is_own_host(std::string_view host, const AccessRules& rules) {
  const std::string_view name = name_of_host(host);
  return name == "localhost" || is_address(name) || contains(rules.host_names, name);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme) && origin.substr(scheme.size()) == host) return true;
  }
  return false;
}

/// "%2B" becomes "+". What is no such code stays.
std::string decoded(std::string_view text) {
  constexpr int kHexadecimal = 16;
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned code = 0;
    const char* const begin = text.data() + i + 1;
    const bool is_code = text[i] == '%' && i + 2 < text.size() &&
                         std::from_chars(begin, begin + 2, code, kHexadecimal).ptr == begin + 2;
    result += is_code ? static_cast<char>(code) : text[i];
    if (is_code) i += 2;
  }
  return result;
}

}  // namespace

std::vector<std::string> origins_of_viewers() {
  return {"https://app.foxglove.dev", "https://lichtblick-suite.github.io", "file://"};
}

Verdict verdict_on(const Caller& caller, const AccessRules& rules) {
  const bool has_token = !rules.token.empty() && are_equal_secrets(caller.token, rules.token);
  const bool is_trusted = caller.is_loopback || contains(rules.trusted_addresses, caller.address);
  if (!is_trusted && !has_token) return Verdict::kNeedsToken;
  if (!has_token && !is_own_host(caller.host, rules)) return Verdict::kForeignHost;
  if (!caller.origin.empty() && !is_own_origin(caller.origin, caller.host) &&
      !contains(rules.origins, caller.origin))
    return Verdict::kForeignOrigin;
  return Verdict::kAllowed;
}

std::string_view explanation_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAllowed: return "";
    case Verdict::kNeedsToken: return "a token is needed: add ?token=... to the address\n";
    case Verdict::kForeignOrigin: return "a page of another server may not connect\n";
    case Verdict::kForeignHost: return "the host's name is not one of this machine\n";
  }
  return "";
}

std::string query_value(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const std::string_view pair = query.substr(0, query.find('&'));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name)
      return decoded(pair.substr(equals + 1));
    query.remove_prefix(std::min(pair.size() + 1, query.size()));
  }
  return {};
}

std::string_view bearer_token(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  const auto is_same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == b;
  };
  const bool is_bearer =
      std::ranges::equal(authorization.substr(0, kScheme.size()), kScheme, is_same);
  return is_bearer ? authorization.substr(kScheme.size()) : std::string_view{};
}

std::string new_token() {
  static constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device random;
  std::string token;
  for (int word = 0; word < 4; ++word) {
    std::uint32_t bits = random();
    for (int digit = 0; digit < 8; ++digit, bits >>= 4) token += kDigits[bits & 15U];
  }
  return token;
}

}  // namespace slammot::gateway
