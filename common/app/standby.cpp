#include "common/app/standby.hpp"

#include <utility>

#include <signal.h>
#include <unistd.h>

#include "common/app/log.hpp"

namespace slammot::app {
namespace {

constexpr const char* kTrouble = "standby";

Leadership::Identity identity_of(const ServiceContext& context) {
  return {context.started_ns(), static_cast<std::uint32_t>(::getpid()), context.options().instance};
}

}  // namespace

Standby::Standby(ServiceContext& context, StateLock* lock)
    : context_(context),
      lock_(lock),
      leadership_(identity_of(context), std::chrono::steady_clock::now()) {
  context.status().set_starting(true);
  context.set_role({.stands_by = true, .term = 0});
  context.read(dds::topics::kHeartbeat, Input::kOccasional, [this](const slammot_Heartbeat& beat) {
    const auto heartbeat = wire::decode(beat);
    if (!heartbeat || heartbeat->name.service != context_.service()) return;
    leadership_.heard(*heartbeat, std::chrono::steady_clock::now());
    if (leadership_.term() > 0) look_around();
  });
}

bool Standby::wait_until_it_leads(const std::function<void(ServiceContext&)>& rehearse) {
  bool has_rehearsed = false;
  const auto leads = [&] {
    if (try_to_lead()) return true;
    if (stood_by_ && rehearse && !std::exchange(has_rehearsed, true)) rehearse(context_);
    return false;
  };
  if (!context_.run_until(leads)) return false;
  context_.status().clear_trouble(kTrouble);
  context_.status().set_starting(false);
  if (stood_by_) log_warn("takes over");
  return true;
}

bool Standby::try_to_lead() {
  switch (leadership_.role(std::chrono::steady_clock::now())) {
    case Leadership::Role::kStandsBy:
      tell("stands by: " + name_of_leader() + " leads");
      return false;
    case Leadership::Role::kMayLead: break;
    default: return false;
  }
  if (lock_ != nullptr && lock_->try_lock() == StateLock::Outcome::kInUse) {
    tell("stands by: " + lock_->reason());
    end_hung_leader();
    return false;
  }
  context_.set_role({.stands_by = false, .term = leadership_.lead()});
  return true;
}

/// Only a process that was heard to lead, and only if the system says that it holds the lock: the
/// number alone may be that of a process in another container.
void Standby::end_hung_leader() const {
  const auto leader = leadership_.leader();
  const auto holder = lock_->holder();
  if (!leader || !holder || *holder != static_cast<pid_t>(leader->process_number) ||
      *holder == ::getpid())
    return;
  log_error("kills process {}: it holds the state and hangs", *holder);
  ::kill(*holder, SIGKILL);
}

void Standby::tell(const std::string& why) {
  context_.status().set_trouble(kTrouble, why);  // is logged with the next status
  stood_by_ = true;
}

std::string Standby::name_of_leader() const {
  const auto leader = leadership_.leader();
  return leader ? "process " + std::to_string(leader->process_number) + " (instance " +
                      leader->instance + ")"
                : "another standby";
}

void Standby::look_around() {
  if (leadership_.role(std::chrono::steady_clock::now()) != Leadership::Role::kSteppedDown) return;
  log_error("stops: {} leads, too, and prevails", name_of_leader());
  context_.stop(kExitInUse);
}

}  // namespace slammot::app
