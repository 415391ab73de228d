#pragma once

#include <functional>
#include <string>

namespace slammot::app {

/// Notices that a network interface was removed and made again, or lost its address: the bus cannot
/// use it any more, since its multicast groups are gone, until the process starts anew.
class InterfaceWatch {
 public:
  /// Identity of the interface as it is now; empty while it has no address.
  using Look = std::function<std::string()>;

  explicit InterfaceWatch(Look look) : look_(std::move(look)), first_(look_()) {}

  /// True if the interface is there, but not the one with which this process began.
  bool was_replaced();

 private:
  Look look_;
  std::string first_;
  bool was_absent_ = false;
};

/// Number and address of an interface, such as "7 10.0.0.2"; empty if it is not there, is down or
/// has no IPv4 address.
std::string identity_of_interface(const std::string& name);

}  // namespace slammot::app
