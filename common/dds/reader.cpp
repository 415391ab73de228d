#include "common/dds/reader.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include "common/dds/cut_sample.hpp"
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

SampleInfo to_info(const dds_sample_info_t& info) {
  return {info.source_timestamp, info.publication_handle, info.instance_handle, info.valid_data,
          info.instance_state != DDS_IST_ALIVE};
}

}  // namespace

QosPointer make_recorder_qos() {
  QosPointer qos(dds_create_qos(), dds_delete_qos);
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  set_recorder_history(qos.get());
  return qos;
}

LoanBase::LoanBase(ReaderBase& reader) : reader_(reader.handle()) {
  if (reader.topic().least_bytes > 0) take_whole(reader);
  else take(reader);
}

LoanBase::~LoanBase() {
  if (type_of_own_ != nullptr)
    for (std::size_t i = 0; i < size_; ++i)
      dds_sample_free(samples_[i], type_of_own_, DDS_FREE_ALL);
  else if (size_ > 0) dds_return_loan(reader_, samples_.data(), static_cast<std::int32_t>(size_));
}

void LoanBase::take(ReaderBase& reader) {
  std::array<dds_sample_info_t, kMost> infos;
  const dds_return_t count = check(dds_take(reader_, samples_.data(), infos.data(), kMost, kMost),
                                   reader.describe("dds_take"));
  size_ = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < size_; ++i) {
    infos_[i] = to_info(infos[i]);
    reader.taken_ += infos_[i].has_value ? 1 : 0;
  }
}

void LoanBase::take_whole(ReaderBase& reader) {
  type_of_own_ = reader.topic().type;
  while (size_ == 0) {
    std::array<ddsi_serdata*, kMost> taken{};
    std::array<dds_sample_info_t, kMost> infos;
    const dds_return_t count =
        check(dds_takecdr(reader_, taken.data(), kMost, infos.data(), DDS_ANY_STATE),
              reader.describe("dds_takecdr"));
    if (count == 0) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      void* const sample = dds_alloc(type_of_own_->m_size);
      const bool is_kept =
          !infos[i].valid_data || read_whole(taken[i], reader.topic().least_bytes, sample);
      ddsi_serdata_unref(taken[i]);
      if (is_kept) {
        samples_[size_] = sample;
        infos_[size_++] = to_info(infos[i]);
        reader.taken_ += infos[i].valid_data ? 1 : 0;
      } else {
        dds_sample_free(sample, type_of_own_, DDS_FREE_ALL);
        ++reader.cut_;
      }
    }
  }
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
