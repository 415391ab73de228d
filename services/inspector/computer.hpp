#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace slammot::inspector {

/// A network interface with an IPv4 address.
struct NetworkInterface {
  std::string name;
  bool is_up = false;
  bool is_loopback = false;
  bool does_multicast = false;
};

/// Room in the file system of a folder.
struct DiskRoom {
  double free_gb = 0.0;
  std::string fault;  ///< Why nothing can be written there; empty if it can.
};

/// What is known of the clock's synchronisation, by adjtimex(2).
struct ClockState {
  bool is_synchronised = false;
  double estimated_error_ms = 0.0;
};

/// Facts of the computer that runs the services. None: not told by this computer.
struct Computer {
  std::optional<std::int64_t> receive_buffer_bytes;  ///< Largest that a socket may ask for.
  std::vector<NetworkInterface> interfaces;
  bool receives_multicast = false;  ///< A datagram sent to a group came back.
  std::optional<ClockState> clock;
  DiskRoom state_disk;
  std::vector<std::string> governors;  ///< Different ones of its processors; empty: none.
};

/// Asks the system; writes and removes a file in the folder of the state, sends a datagram.
Computer examine_computer(const std::filesystem::path& state_folder);

}  // namespace slammot::inspector
