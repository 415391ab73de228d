#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/app/pace.hpp"
#include "common/dds/raw_writer.hpp"
#include "common/dds/wait_set.hpp"
#include "services/slammot/replay_comparison.hpp"
#include "services/slammot/replay_order.hpp"
#include "services/slammot/replay_plan.hpp"

namespace slammot {

/// What of a recording is replayed.
struct ReplaySource {
  const mcap::File& file;
  ReplayPlan plan;
  std::string vehicle_id;
};

/// Feeds a service what it received in a recording, in the recorded order, and compares what it
/// publishes with what was recorded. A recorded output holds back all later inputs until the
/// service has published its counterpart: it can know no more than it knew then.
class ServiceReplay {
 public:
  ServiceReplay(const dds::Participant& participant, const ReplaySource& source,
                ReplayComparison& comparison);

  /// Waits until the service reads its inputs; false at the time-out.
  bool wait_for_service(std::chrono::seconds timeout);

  enum class End { kDone, kStopped, kSilent };
  /// Unlimited pace: time in which the service has nothing to answer is left out. `is_stopped` is
  /// asked between messages. Silent: the service left several recorded outputs in a row out.
  End run(app::Pace pace, const std::function<bool()>& is_stopped);

  std::uint64_t inputs() const { return inputs_; }

 private:
  /// Samples are paired by topic, key and stamp, those of equal ones in their order.
  using Identity = std::string;
  struct Output {
    std::string topic;
    std::shared_ptr<const dds::RawTopic> raw;
    std::unique_ptr<dds::RawReader> reader;
    std::map<Identity, std::deque<std::vector<std::uint8_t>>> published;
    std::optional<std::int64_t> first_ns, last_ns;  ///< Stamps in the recording.
  };

  bool is_of_vehicle(const mcap::Message& message, const dds::TypeModel& model) const;
  void take(Output& output);
  void await_turn(std::int64_t time_ns, app::Pace& pace);
  void feed(const mcap::Message& message);
  void compare(const mcap::Message& message, Output& output);
  bool await(Output& output, const Identity& identity);
  void note_left_over();
  double seconds_of(const mcap::Message& message) const;

  ReplaySource source_;
  ReplayComparison& comparison_;
  dds::WaitSet wait_set_;
  std::map<mcap::ChannelId,
           std::pair<std::shared_ptr<const dds::RawTopic>, std::unique_ptr<dds::RawWriter>>>
      inputs_of_;
  std::map<mcap::ChannelId, Output> outputs_of_;
  std::optional<std::int64_t> unanswered_ns_;  ///< Time of the last input since a trigger that
                                               ///< was not answered.
  bool has_begun_ = false;                     ///< A trigger was fed.
  std::uint64_t inputs_ = 0;
  int silences_ = 0;  ///< Recorded outputs in a row that did not come.
};

}  // namespace slammot
