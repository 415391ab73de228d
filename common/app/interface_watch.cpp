#include "common/app/interface_watch.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <memory>

namespace slammot::app {

bool InterfaceWatch::was_replaced() {
  const std::string now = look_();
  if (now.empty()) was_absent_ = true;
  return !now.empty() && (was_absent_ || now != first_);
}

std::string identity_of_interface(const std::string& name) {
  ifaddrs* all = nullptr;
  if (getifaddrs(&all) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owned(all, freeifaddrs);
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    const bool is_meant = name == one->ifa_name && one->ifa_addr != nullptr &&
                          one->ifa_addr->sa_family == AF_INET && (one->ifa_flags & IFF_UP) != 0;
    if (!is_meant) continue;
    char address[INET_ADDRSTRLEN] = "";
    const auto* ipv4 = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    inet_ntop(AF_INET, &ipv4->sin_addr, address, sizeof address);
    return std::to_string(if_nametoindex(name.c_str())) + " " + address;
  }
  return {};
}

}  // namespace slammot::app
