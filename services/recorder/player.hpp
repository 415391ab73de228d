#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/dds/raw_writer.hpp"
#include "common/mcap/message_cursor.hpp"
#include "services/recorder/kept_samples.hpp"
#include "services/recorder/play_control.hpp"
#include "services/recorder/topic_selection.hpp"

namespace slammot::recorder {

struct PlayCounters {
  std::uint64_t played = 0;
  std::uint64_t malformed = 0;  ///< Not sent: no samples of their type.
  std::uint64_t timed_out = 0;  ///< Not sent: a reader blocked for too long.
};

/// Part of a recording, by log time.
struct PlayRange {
  std::int64_t from_ns = 0;
  std::int64_t to_ns = 0;  ///< Inclusive.
};

/// Writes the messages of a recording to the bus as they were: the same bytes, source times and
/// QoS.
class Player {
 public:
  Player(const dds::Participant& participant, const mcap::File& file,
         const TopicSelection& selection);

  /// Topics that are played, and those of the selection that cannot be: recorded otherwise.
  std::size_t topic_count() const { return writers_.size(); }
  std::set<std::string> topics() const;
  const std::vector<std::string>& unplayable() const { return unplayable_; }
  /// False where nothing of the chosen topics was recorded in that time.
  bool has_message_in(const PlayRange& range) const;
  /// True of this player's own samples.
  bool has_writer(std::uint64_t writer_handle) const;

  /// Plays once, by the log times, as `control` says. What the bus kept for late joiners when the
  /// played part begins, such as the map, is written first; so it is after a seek. False when
  /// stopped.
  bool play(const PlayRange& range, PlayControl& control);
  /// Begins to read what seeks need, so that the first one is as quick as the others.
  void prepare_seeks();
  /// Writes what the bus kept at that time, of topics that keep a value for late joiners.
  void restore(std::int64_t log_time_ns);

  /// Waits until all connected readers have everything; false at the time-out.
  bool wait_for_acknowledgements(std::chrono::nanoseconds timeout) const;
  const PlayCounters& counters() const { return counters_; }

 private:
  enum class Keeps { kNothing, kRareValues, kFrequentValues };  ///< For late joiners.
  struct Output {
    std::shared_ptr<const dds::RawTopic> topic;
    std::unique_ptr<dds::RawWriter> writer;
    Keeps keeps = Keeps::kNothing;
  };

  Keeps kept_by(mcap::ChannelId channel, const dds::OfferedQos& qos) const;
  std::set<std::string> topics_that_keep(Keeps what) const;
  KeyOf key_of() const;
  PlayControl::Turn play_from(const PlayRange& range, PlayControl& control);
  void write(mcap::ChannelId channel, const dds::RawSample& sample);

  const mcap::File& file_;
  std::map<mcap::ChannelId, Output> writers_;
  std::unique_ptr<KeptSamples> rare_values_;  ///< Its thread reads the models of the writers.
  std::vector<std::string> unplayable_;
  PlayCounters counters_;
};

}  // namespace slammot::recorder
