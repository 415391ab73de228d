#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/app/input_watch.hpp"
#include "common/wire/service.hpp"

namespace slammot::app {

/// Decides which of several processes of one service and vehicle does the work. The others stand
/// by. Each process decides by the heartbeats of the others: who leads stays the leader until it
/// falls silent or says that it stops; then the one that started first takes over, in a higher
/// term. If two lead, as after a cut of the network, the lower term steps down, and of one term the
/// later start.
class Leadership {
 public:
  /// A leader that was not heard for this time is replaced: four of its heartbeats.
  static constexpr std::chrono::milliseconds kLease{200};

  /// A process, unique also among containers, in which all have the same number.
  struct Identity {
    std::int64_t started_ns = 0;  ///< System clock.
    std::uint32_t process_number = 0;
    std::string instance;
    auto operator<=>(const Identity&) const = default;
  };
  enum class Role {
    kUndecided,    ///< Listens for others.
    kStandsBy,     ///< Another one leads.
    kMayLead,      ///< Nobody leads, and no other standby comes first.
    kLeads,        ///< Since lead().
    kSteppedDown,  ///< Another one prevails: this process has to end.
  };

  Leadership(Identity self, SteadyTime now) : self_(std::move(self)), since_(now) {}

  /// Of this vehicle and service, also its own.
  void heard(const wire::Heartbeat& beat, SteadyTime now);

  Role role(SteadyTime now) const;

  /// Begins to lead in the next term, which it returns. Precondition: role() is kMayLead.
  std::uint32_t lead();
  std::uint32_t term() const { return term_; }

  /// The leader that was heard last, if one was.
  std::optional<Identity> leader() const;

 private:
  struct Other {
    Identity identity;
    std::uint32_t term = 0;
    bool stands_by = false;
    bool stops = false;
    SteadyTime last;
  };

  bool is_alive(const Other& other, SteadyTime now) const {
    return !other.stops && now - other.last < kLease;
  }
  bool prevails(const Other& other) const;

  Identity self_;
  SteadyTime since_;
  std::uint32_t term_ = 0;          ///< 0: does not lead.
  std::uint32_t highest_term_ = 0;  ///< Heard so far.
  std::vector<Other> others_;
};

}  // namespace slammot::app
