#include "common/dds/writer.hpp"

#include <algorithm>

#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {

WriterBase::WriterBase(const Participant& participant, const TopicInfo& info)
    : Endpoint(participant, info, Side::kWriter, make_writer_qos(qos_profile(info.flow)).get()),
      notes_keys_(has_one_writer(info)) {}

WriterBase::WriterBase(const Participant& participant, const TopicInfo& info, Entity topic,
                       const dds_qos* qos)
    : Endpoint(participant, info, std::move(topic), Side::kWriter, qos), notes_keys_(false) {}

WriteResult WriterBase::write_sample(const void* sample) {
  const WriteResult result = written(dds_write(handle(), sample));
  if (notes_keys_) note_key(sample);
  return result;
}

void WriterBase::note_key(const void* sample) {
  const dds_instance_handle_t key = dds_lookup_instance(handle(), sample);
  if (key != DDS_HANDLE_NIL && std::ranges::find(keys_, key) == keys_.end()) keys_.push_back(key);
}

void WriterBase::hand_over() {
  for (const dds_instance_handle_t key : keys_) {
    // Unregistering alone says nothing while a dead process is not missed yet that had the key,
    // too.
    check(dds_dispose_ih(handle(), key), describe("dds_dispose_ih"));
    check(dds_unregister_instance_ih(handle(), key), describe("dds_unregister_instance_ih"));
  }
  keys_.clear();
}

WriteResult WriterBase::written(std::int32_t code) {
  if (code == DDS_RETCODE_TIMEOUT) {
    ++counters_.timed_out;
    return WriteResult::kTimedOut;
  }
  check(code, describe("dds_write"));
  ++counters_.written;
  return WriteResult::kWritten;
}

void WriterBase::end_sample(const void* sample) {
  // Disposing takes the sample from the history kept for late joiners, unregistering frees the key.
  check(dds_dispose(handle(), sample), describe("dds_dispose"));
  check(dds_unregister_instance(handle(), sample), describe("dds_unregister_instance"));
}

std::uint32_t WriterBase::matched_readers() const {
  dds_publication_matched_status_t status{};
  check(dds_get_publication_matched_status(handle(), &status),
        describe("dds_get_publication_matched_status"));
  return status.current_count;
}

bool WriterBase::wait_for_readers(std::uint32_t count, std::chrono::nanoseconds timeout) const {
  return wait_until([&] { return matched_readers() >= count; }, timeout);
}

bool WriterBase::wait_for_acknowledgements(std::chrono::nanoseconds timeout) const {
  const dds_return_t code = dds_wait_for_acks(handle(), timeout.count());
  if (code == DDS_RETCODE_TIMEOUT) return false;
  check(code, describe("dds_wait_for_acks"));
  return true;
}

std::optional<QosMismatch> WriterBase::mismatch() const {
  dds_offered_incompatible_qos_status_t status{};
  check(dds_get_offered_incompatible_qos_status(handle(), &status),
        describe("dds_get_offered_incompatible_qos_status"));
  return Endpoint::mismatch(status.total_count, status.last_policy_id);
}

bool WriterBase::wait_for_mismatch(std::chrono::nanoseconds timeout) const {
  return wait_until([&] { return mismatch().has_value(); }, timeout);
}

}  // namespace slammot::dds
