#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <string>

#include "common/app/service_context.hpp"
#include "services/gateway/calls.hpp"

namespace slammot::gateway {

/// Sends calls of viewers as commands over the bus, and brings the replies back.
class BusCalls {
 public:
  explicit BusCalls(app::ServiceContext& context);

  /// From any thread.
  void take(ViewerCall call);

 private:
  struct Sent {
    ViewerCall call;
    app::SteadyTime given_up;
  };

  void send_waiting();
  void take(const slammot_Reply& sample);
  void give_up_old();

  app::ServiceContext& context_;
  dds::Writer<slammot_Command>& commands_;
  std::string requester_;
  std::uint64_t next_number_ = 1;
  std::map<std::uint64_t, Sent> sent_;
  std::mutex mutex_;
  std::deque<ViewerCall> waiting_;  ///< For the loop's thread.
};

}  // namespace slammot::gateway
