#include "common/dds/raw_reader.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include "common/dds/opaque_type.hpp"
#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {
namespace {

QosPointer qos_for(const OfferedQos& offered) {
  QosPointer qos = make_recorder_qos();
  dds_qset_reliability(qos.get(),
                       offered.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  dds_qset_durability(qos.get(), offered.is_transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                            : DDS_DURABILITY_VOLATILE);
  dds_qset_ownership(qos.get(),
                     offered.is_exclusive ? DDS_OWNERSHIP_EXCLUSIVE : DDS_OWNERSHIP_SHARED);
  set_partitions(offered, qos.get());
  const std::array<dds_data_representation_id_t, 2> any = {DDS_DATA_REPRESENTATION_XCDR1,
                                                           DDS_DATA_REPRESENTATION_XCDR2};
  dds_qset_data_representation(qos.get(), any.size(), any.data());
  return qos;
}

void hand_over(ddsi_serdata* sample, std::int64_t source_time_ns,
               const std::function<void(const RawSample&)>& handle) {
  ddsrt_iovec_t bytes{};
  const std::uint32_t size = ddsi_serdata_size(sample);
  ddsi_serdata* const lent = ddsi_serdata_to_ser_ref(sample, 0, size, &bytes);
  handle({{static_cast<const std::uint8_t*>(bytes.iov_base), size}, source_time_ns});
  ddsi_serdata_to_ser_unref(lent, &bytes);
}

}  // namespace

RawReader::RawReader(const Participant& participant, std::shared_ptr<const RawTopic> topic,
                     const OfferedQos& offered)
    : ReaderBase(participant, topic->info(),
                 create_opaque_topic(participant, topic, offered, Instances::kOne).entity,
                 qos_for(offered).get()),
      raw_topic_(std::move(topic)) {}

std::size_t RawReader::take_each(const std::function<void(const RawSample&)>& handle) {
  std::size_t total = 0;
  for (;;) {
    std::array<ddsi_serdata*, LoanBase::kMost> samples{};
    std::array<dds_sample_info_t, LoanBase::kMost> infos;
    const dds_return_t count = check(dds_takecdr(ReaderBase::handle(), samples.data(),
                                                 LoanBase::kMost, infos.data(), DDS_ANY_STATE),
                                     describe("dds_takecdr"));
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (infos[i].valid_data) {
        hand_over(samples[i], infos[i].source_timestamp, handle);
        ++total;
        count_taken();
      }
      ddsi_serdata_unref(samples[i]);
    }
    if (count < static_cast<dds_return_t>(LoanBase::kMost)) return total;
  }
}

}  // namespace slammot::dds
