#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/dds/endpoint.hpp"

namespace slammot::dds {

enum class WriteResult {
  kWritten,
  kTimedOut,  ///< A slow reader blocked the write for longer than the profile's max_blocking; the
              ///< sample was not sent.
};

struct WriterCounters {
  std::uint64_t written = 0;
  std::uint64_t timed_out = 0;
};

class WriterBase : public Endpoint {
 public:
  std::uint32_t matched_readers() const;
  /// Waits until at least `count` readers are connected; false at the timeout.
  bool wait_for_readers(std::uint32_t count, std::chrono::nanoseconds timeout) const;
  /// Waits until all connected readers have all that was written; false at the timeout.
  bool wait_for_acknowledgements(std::chrono::nanoseconds timeout) const;
  /// Readers met that could not be connected.
  std::optional<QosMismatch> mismatch() const;
  /// Waits for the first one; false at the timeout.
  bool wait_for_mismatch(std::chrono::nanoseconds timeout) const;
  const WriterCounters& counters() const { return counters_; }

  /// Says that this writer ends, where its topic has one writer a key: readers accept another one
  /// at once. Nothing is to be written afterwards.
  void hand_over();

 protected:
  WriterBase(const Participant& participant, const TopicInfo& info);
  WriterBase(const Participant& participant, const TopicInfo& info, Entity topic,
             const dds_qos* qos);
  /// Counts the outcome of a write, by the library's return code.
  WriteResult written(std::int32_t code);
  WriteResult write_sample(const void* sample);
  void end_sample(const void* sample);

 private:
  void note_key(const void* sample);

  WriterCounters counters_;
  bool notes_keys_;
  std::vector<std::uint64_t> keys_;  ///< Of what was written, where they are noted.
};

/// Writes samples of one topic with the topic's own QoS. Not thread-safe.
template <typename Sample>
class Writer : public WriterBase {
 public:
  Writer(const Participant& participant, const Topic<Sample>& topic)
      : WriterBase(participant, topic) {}

  /// Throws Error when the sample breaks its type's limits.
  WriteResult write(const Sample& sample) { return write_sample(&sample); }

  /// Says that the sample's key has ended, and frees what was kept for late joiners. Without it
  /// every key that ever was costs memory for good, here and in the readers.
  void end(const Sample& sample) { end_sample(&sample); }
};

}  // namespace slammot::dds
