#include "services/gateway/bus_calls.hpp"

#include <unistd.h>

#include <utility>

namespace slammot::gateway {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookPeriod = 20ms;
constexpr auto kPatience = 3s;
constexpr std::size_t kMostWaiting = 64;

}  // namespace

BusCalls::BusCalls(app::ServiceContext& context)
    : context_(context),
      commands_(context.write(dds::topics::kCommand)),
      requester_("gateway-" + std::to_string(getpid())) {
  context.read(dds::topics::kReply, app::Input::kOccasional,
               [this](const auto& sample) { take(sample); });
  context.every(kLookPeriod, [this] {
    send_waiting();
    give_up_old();
  });
}

void BusCalls::take(ViewerCall call) {
  {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() < kMostWaiting) return waiting_.push_back(std::move(call));
  }
  call.answer("too many calls at once");
}

void BusCalls::send_waiting() {
  std::deque<ViewerCall> waiting;
  {
    const std::scoped_lock lock(mutex_);
    waiting.swap(waiting_);
  }
  for (ViewerCall& call : waiting) {
    const std::uint64_t number = next_number_++;
    commands_.write(wire::encode(wire::Command{.vehicle_id = context_.vehicle_id(),
                                               .service = std::string(call.service->service),
                                               .requester = requester_,
                                               .request_number = number,
                                               .verb = std::string(call.service->verb),
                                               .argument = call.argument}));
    sent_[number] = {std::move(call), std::chrono::steady_clock::now() + kPatience};
  }
}

void BusCalls::take(const slammot_Reply& sample) {
  const auto reply = wire::decode(sample);
  if (!reply || reply->requester != requester_) return;
  const auto sent = sent_.find(reply->request_number);
  if (sent == sent_.end()) return;
  sent->second.call.answer(reply->outcome == wire::Outcome::kDone ? "" : reply->explanation);
  sent_.erase(sent);
}

void BusCalls::give_up_old() {
  const auto now = std::chrono::steady_clock::now();
  std::erase_if(sent_, [&](const auto& item) {
    const Sent& sent = item.second;
    if (now < sent.given_up) return false;
    sent.call.answer("no answer from " + std::string(sent.call.service->service));
    return true;
  });
}

}  // namespace slammot::gateway
