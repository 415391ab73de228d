#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/app/pace.hpp"
#include "common/dds/raw_writer.hpp"
#include "common/mcap/message_cursor.hpp"
#include "services/recorder/topic_selection.hpp"

namespace slammot::recorder {

struct PlayCounters {
  std::uint64_t played = 0;
  std::uint64_t malformed = 0;  ///< Not sent: no samples of their type.
  std::uint64_t timed_out = 0;  ///< Not sent: a reader blocked for too long.
};

/// Writes the messages of a recording to the bus as they were: the same bytes, source times and
/// QoS.
class Player {
 public:
  Player(const dds::Participant& participant, const mcap::File& file,
         const TopicSelection& selection);

  /// Topics that are played, and those of the selection that cannot be: recorded otherwise.
  std::size_t topic_count() const { return writers_.size(); }
  const std::vector<std::string>& unplayable() const { return unplayable_; }

  /// Plays once, by the log times. Returns early when `is_stopped`.
  void play(std::int64_t from_ns, std::int64_t to_ns, app::Pace pace,
            const std::atomic<bool>& is_stopped);

  /// Waits until all connected readers have everything; false at the time-out.
  bool wait_for_acknowledgements(std::chrono::nanoseconds timeout) const;
  const PlayCounters& counters() const { return counters_; }

 private:
  void write(const mcap::Message& message);

  const mcap::File& file_;
  std::map<mcap::ChannelId, std::unique_ptr<dds::RawWriter>> writers_;
  std::vector<std::string> unplayable_;
  PlayCounters counters_;
};

}  // namespace slammot::recorder
