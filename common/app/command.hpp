#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/wire/service.hpp"

namespace slammot::app {

using CommandOutcome = wire::Outcome;

struct CommandResult {
  CommandOutcome outcome = CommandOutcome::kDone;
  std::string explanation;
};

struct CommandRequest {
  std::string requester;
  std::uint64_t number = 0;
  std::string verb;
  std::string argument;
};

/// Executes each requested command once: a request repeated after a lost reply gets the same reply.
class CommandDesk {
 public:
  using Handler = std::function<CommandResult(std::string_view argument)>;

  void on(const std::string& verb, Handler handler) { handlers_[verb] = std::move(handler); }
  CommandResult answer(const CommandRequest& request);

 private:
  static constexpr std::size_t kRemembered = 64;
  struct Answered {
    std::string requester;
    std::uint64_t number;
    CommandResult result;
  };

  std::map<std::string, Handler> handlers_;
  std::deque<Answered> answered_;
};

}  // namespace slammot::app
