#include "services/inspector/computer.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <set>

namespace slammot::inspector {
namespace {

std::optional<std::int64_t> number_in(const std::filesystem::path& file) {
  std::int64_t number = 0;
  return std::ifstream(file) >> number ? std::optional(number) : std::nullopt;
}

std::vector<NetworkInterface> interfaces() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&::freeifaddrs)> owner(list, ::freeifaddrs);
  std::vector<NetworkInterface> found;
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    found.push_back({one->ifa_name, (one->ifa_flags & IFF_UP) != 0,
                     (one->ifa_flags & IFF_LOOPBACK) != 0, (one->ifa_flags & IFF_MULTICAST) != 0});
  }
  return found;
}

/// A socket that closes itself.
struct Socket {
  int descriptor = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  Socket() = default;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

/// Sends to the group that DDS uses (RTPS 2.2, 9.6.1.4.1), on a free port.
bool receives_multicast() {
  const Socket socket;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  ip_mreq group{};
  ::inet_pton(AF_INET, "239.255.0.1", &group.imr_multiaddr);
  if (::bind(socket.descriptor, generic, size) != 0 ||
      ::getsockname(socket.descriptor, generic, &size) != 0 ||
      ::setsockopt(socket.descriptor, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
    return false;
  address.sin_addr = group.imr_multiaddr;
  const char byte = 1;
  if (::sendto(socket.descriptor, &byte, 1, 0, generic, sizeof address) != 1) return false;
  pollfd waited{socket.descriptor, POLLIN, 0};
  constexpr int kPatienceMs = 500;
  return ::poll(&waited, 1, kPatienceMs) == 1;
}

std::optional<ClockState> clock_state() {
  timex state{};
  const int result = ::adjtimex(&state);
  if (result < 0) return std::nullopt;
  return ClockState{result != TIME_ERROR && (state.status & STA_UNSYNC) == 0,
                    static_cast<double>(state.esterror) * 1e-3};
}

DiskRoom disk_room(const std::filesystem::path& folder) {
  std::error_code error;
  const bool is_new = !std::filesystem::exists(folder, error);
  std::filesystem::create_directories(folder, error);
  if (error) return {0.0, "cannot make " + folder.string() + ": " + error.message()};
  DiskRoom room;
  struct statvfs figures {};
  if (::statvfs(folder.c_str(), &figures) == 0)
    room.free_gb =
        static_cast<double>(figures.f_bavail) * static_cast<double>(figures.f_frsize) * 1e-9;
  const auto probe = folder / "doctor.unfinished";
  std::ofstream file(probe, std::ios::trunc);
  file << "probe" << std::flush;
  if (!file) room.fault = "cannot write to " + folder.string() + ": " + std::strerror(errno);
  file.close();
  std::filesystem::remove(probe, error);
  if (is_new) std::filesystem::remove(folder, error);
  return room;
}

std::vector<std::string> governors() {
  std::set<std::string> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/sys/devices/system/cpu", error)) {
    std::string governor;
    if (std::ifstream(entry.path() / "cpufreq/scaling_governor") >> governor)
      found.insert(governor);
  }
  return {found.begin(), found.end()};
}

}  // namespace

Computer examine_computer(const std::filesystem::path& state_folder) {
  return {number_in("/proc/sys/net/core/rmem_max"),
          interfaces(),
          receives_multicast(),
          clock_state(),
          disk_room(state_folder),
          governors()};
}

}  // namespace slammot::inspector
