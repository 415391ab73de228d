#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/app/leadership.hpp"
#include "common/app/service_context.hpp"
#include "common/app/state_lock.hpp"

namespace slammot::app {

/// Exit code of a process that another one makes superfluous: the state is in use, or another
/// process leads.
inline constexpr int kExitInUse = 4;

/// Lets one process of a service and vehicle work and the others wait until it ends. The others
/// hold nothing but what the bus gives (ServiceContext::prepare), and start as after a crash of the
/// leader: from the state that it left.
/// A leader on this machine that holds the state and is silent hangs: the standby kills it, so that
/// the state never has two owners.
class Standby {
 public:
  /// `lock` is taken before this process leads; null for a service without state.
  Standby(ServiceContext& context, StateLock* lock);
  Standby(const Standby&) = delete;
  Standby& operator=(const Standby&) = delete;

  /// Waits until this process leads; false if it was stopped before. rehearse, which may be
  /// empty, is called once, when it stands by. Afterwards the process is stopped with kExitInUse
  /// when another one prevails.
  bool wait_until_it_leads(const std::function<void(ServiceContext&)>& rehearse);

 private:
  bool try_to_lead();
  void end_hung_leader() const;
  void tell(const std::string& why);
  std::string name_of_leader() const;
  void look_around();

  ServiceContext& context_;
  StateLock* lock_;
  Leadership leadership_;
  bool stood_by_ = false;
};

}  // namespace slammot::app
