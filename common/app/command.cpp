#include "common/app/command.hpp"

#include <algorithm>

namespace slammot::app {

CommandResult CommandDesk::answer(const CommandRequest& request) {
  const auto known = std::ranges::find_if(answered_, [&](const Answered& answered) {
    return answered.requester == request.requester && answered.number == request.number;
  });
  if (known != answered_.end()) return known->result;
  const auto handler = handlers_.find(request.verb);
  const CommandResult result =
      handler != handlers_.end()
          ? handler->second(request.argument)
          : CommandResult{CommandOutcome::kUnknownVerb, "unknown command '" + request.verb + "'"};
  answered_.push_back({request.requester, request.number, result});
  if (answered_.size() > kRemembered) answered_.pop_front();
  return result;
}

}  // namespace slammot::app
