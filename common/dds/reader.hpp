#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>

#include "common/dds/endpoint.hpp"

namespace slammot::dds {

enum class History {
  kProfile,   ///< Depth of the topic's profile.
  kRecorder,  ///< The last 10,000 samples a key, for a reader that needs all.
  kRestart,   ///< As many as the writer keeps for restarts, also from before this reader: a service
              ///< that was restarted does what the process before has left.
  kRestartedRecorder,  ///< Both: all from now on, and what the writer kept for restarts.
};

struct ReaderCounters {
  std::uint64_t taken = 0;
  std::uint64_t lost = 0;      ///< Overwritten or never arrived, as far as the library can tell.
  std::uint64_t rejected = 0;  ///< Refused because the reader's history was full.
};

struct SampleInfo {
  std::int64_t source_time_ns = 0;  ///< The writer's system clock when it wrote.
  std::uint64_t writer_handle = 0;  ///< Tells writers apart while they live.
  std::uint64_t key_handle = 0;     ///< Tells keys apart.
  bool has_value = false;  ///< False: the key ended, or lost its last writer; only the key can be
                           ///< read, and not even that where the topic has least_bytes.
  bool has_ended = false;  ///< The same, told together with a value.
};

class ReaderBase;

/// Samples lent by a reader, given back at the end. Must not outlive the reader.
class LoanBase {
 public:
  static constexpr std::size_t kMost = 32;

  explicit LoanBase(ReaderBase& reader);
  ~LoanBase();
  LoanBase(const LoanBase&) = delete;
  LoanBase& operator=(const LoanBase&) = delete;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const SampleInfo& info(std::size_t index) const { return infos_[index]; }

 protected:
  const void* sample(std::size_t index) const { return samples_[index]; }

 private:
  void take(ReaderBase& reader);
  /// The same; leaves out what ends before an appendable structure within it.
  void take_whole(ReaderBase& reader);

  Entity::Handle reader_;
  const dds_topic_descriptor* type_of_own_ = nullptr;  // of samples that are not the library's
  std::array<void*, kMost> samples_{};
  std::array<SampleInfo, kMost> infos_{};
  std::size_t size_ = 0;
};

template <typename Sample>
class Loan : public LoanBase {
 public:
  using LoanBase::LoanBase;
  const Sample& operator[](std::size_t index) const {
    return *static_cast<const Sample*>(sample(index));
  }
};

class ReaderBase : public Endpoint {
 public:
  std::uint32_t matched_writers() const;
  /// True if the writer is known and alive, as far as discovery can tell.
  bool is_matched(std::uint64_t writer_handle) const;
  /// Waits until at least `count` writers are connected; false at the timeout.
  bool wait_for_writers(std::uint32_t count, std::chrono::nanoseconds timeout) const;
  /// Writers met that could not be connected.
  std::optional<QosMismatch> mismatch() const;
  /// Waits for the first one; false at the timeout.
  bool wait_for_mismatch(std::chrono::nanoseconds timeout) const;
  ReaderCounters counters() const;
  /// Samples that were left out since they were shorter than the topic's least_bytes.
  std::uint64_t cut() const { return cut_; }

 protected:
  ReaderBase(const Participant& participant, const TopicInfo& info, History history);
  ReaderBase(const Participant& participant, const TopicInfo& info, Entity topic,
             const dds_qos* qos);
  void count_taken() { ++taken_; }

 private:
  friend class LoanBase;
  friend class WaitSet;
  std::uint64_t taken_ = 0;
  std::uint64_t cut_ = 0;
  Entity data_available_;  // condition: there are samples to take
};

/// Reads samples of one topic with the topic's own QoS. Not thread-safe.
template <typename Sample>
class Reader : public ReaderBase {
 public:
  Reader(const Participant& participant, const Topic<Sample>& topic,
         History history = History::kProfile)
      : ReaderBase(participant, topic, history) {}

  /// The oldest unread samples, at most LoanBase::kMost; does not wait.
  Loan<Sample> take() { return Loan<Sample>(*this); }

  /// Calls `handle(sample)` or `handle(sample, info)` for every unread value, oldest first. Returns
  /// their number.
  template <typename Handle>
  std::size_t take_each(Handle&& handle) {
    return take_each(handle, [](const SampleInfo&) {});
  }

  /// The same; calls `ended(info)` where a key ended or lost its last writer.
  template <typename Handle, typename Ended>
  std::size_t take_each(Handle&& handle, Ended&& ended) {
    std::size_t count = 0;
    while (const auto batch = take_batch(handle, ended, [](bool) { return false; }))
      count += *batch;
    return count;
  }

  /// The same for at most LoanBase::kMost values, so that a long queue does not keep the caller.
  /// Leaves the oldest out where `leaves_out(is_long)` says so; `is_long`: there are as many or
  /// more. None if there was nothing.
  template <typename Handle, typename Ended, typename LeavesOut>
  std::optional<std::size_t> take_batch(Handle&& handle, Ended&& ended, LeavesOut&& leaves_out) {
    for (;;) {
      const Loan<Sample> loan = take();
      if (loan.empty()) return std::nullopt;
      if (!leaves_out(loan.size() == LoanBase::kMost)) return hand_on(loan, handle, ended);
    }
  }

 private:
  template <typename Handle, typename Ended>
  static std::size_t hand_on(const Loan<Sample>& loan, Handle& handle, Ended& ended) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < loan.size(); ++i) {
      const SampleInfo& info = loan.info(i);
      if (info.has_value) {
        if constexpr (std::is_invocable_v<Handle&, const Sample&, const SampleInfo&>)
          handle(loan[i], info);
        else handle(loan[i]);
        ++count;
      }
      if (!info.has_value || info.has_ended) ended(info);
    }
    return count;
  }
};

}  // namespace slammot::dds
