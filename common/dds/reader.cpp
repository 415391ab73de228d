#include "common/dds/reader.hpp"

#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {
namespace {

constexpr std::int32_t kRecorderDepth = 10'000;
constexpr std::int32_t kRecorderMaxSamples = 100'000;  // over all keys; at 2 kB a sample 200 MB

void set_recorder_history(dds_qos_t* qos) {
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kRecorderDepth);
  dds_qset_resource_limits(qos, kRecorderMaxSamples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
}

QosPointer reader_qos(const TopicInfo& info, History history) {
  if (history == History::kRestart) return make_restart_reader_qos(qos_profile(info.flow));
  const bool comes_late = history == History::kRestartedRecorder;
  QosPointer qos = comes_late ? make_restart_reader_qos(qos_profile(info.flow))
                              : make_reader_qos(qos_profile(info.flow));
  if (history == History::kRecorder || comes_late) set_recorder_history(qos.get());
  return qos;
}

}  // namespace

QosPointer make_recorder_qos() {
  QosPointer qos(dds_create_qos(), dds_delete_qos);
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  set_recorder_history(qos.get());
  return qos;
}

LoanBase::LoanBase(ReaderBase& reader) : reader_(reader.handle()) {
  std::array<dds_sample_info_t, kMost> infos;
  const dds_return_t count = check(dds_take(reader_, samples_.data(), infos.data(), kMost, kMost),
                                   reader.describe("dds_take"));
  size_ = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < size_; ++i) {
    infos_[i] = {infos[i].source_timestamp, infos[i].publication_handle, infos[i].instance_handle,
                 infos[i].valid_data, infos[i].instance_state != DDS_IST_ALIVE};
    reader.taken_ += infos[i].valid_data ? 1 : 0;
  }
}

LoanBase::~LoanBase() {
  if (size_ > 0) dds_return_loan(reader_, samples_.data(), static_cast<std::int32_t>(size_));
}

ReaderBase::ReaderBase(const Participant& participant, const TopicInfo& info, History history)
    : Endpoint(participant, info, Side::kReader, reader_qos(info, history).get()),
      data_available_(dds_create_readcondition(handle(), DDS_ANY_STATE),
                      describe("dds_create_readcondition")) {}

ReaderBase::ReaderBase(const Participant& participant, const TopicInfo& info, Entity topic,
                       const dds_qos* qos)
    : Endpoint(participant, info, std::move(topic), Side::kReader, qos),
      data_available_(dds_create_readcondition(handle(), DDS_ANY_STATE),
                      describe("dds_create_readcondition")) {}

std::uint32_t ReaderBase::matched_writers() const {
  dds_subscription_matched_status_t status{};
  check(dds_get_subscription_matched_status(handle(), &status),
        describe("dds_get_subscription_matched_status"));
  return status.current_count;
}

bool ReaderBase::is_matched(std::uint64_t writer_handle) const {
  dds_builtintopic_endpoint_t* const writer =
      dds_get_matched_publication_data(handle(), writer_handle);
  if (writer == nullptr) return false;
  dds_builtintopic_free_endpoint(writer);
  return true;
}

bool ReaderBase::wait_for_writers(std::uint32_t count, std::chrono::nanoseconds timeout) const {
  return wait_until([&] { return matched_writers() >= count; }, timeout);
}

std::optional<QosMismatch> ReaderBase::mismatch() const {
  dds_requested_incompatible_qos_status_t status{};
  check(dds_get_requested_incompatible_qos_status(handle(), &status),
        describe("dds_get_requested_incompatible_qos_status"));
  return Endpoint::mismatch(status.total_count, status.last_policy_id);
}

bool ReaderBase::wait_for_mismatch(std::chrono::nanoseconds timeout) const {
  return wait_until([&] { return mismatch().has_value(); }, timeout);
}

ReaderCounters ReaderBase::counters() const {
  dds_sample_lost_status_t lost{};
  dds_sample_rejected_status_t rejected{};
  check(dds_get_sample_lost_status(handle(), &lost), describe("dds_get_sample_lost_status"));
  check(dds_get_sample_rejected_status(handle(), &rejected),
        describe("dds_get_sample_rejected_status"));
  return {taken_, lost.total_count, rejected.total_count};
}

}  // namespace slammot::dds
