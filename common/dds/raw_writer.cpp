#include "common/dds/raw_writer.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include "common/dds/qos_pointer.hpp"

namespace slammot::dds {
namespace {

constexpr std::size_t kCdrHeaderBytes = 4;

QosPointer qos_for(const TopicInfo& info, const OfferedQos& offered) {
  QosPointer qos(dds_create_qos(), dds_delete_qos);
  dds_qset_reliability(qos.get(),
                       offered.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_MSECS(100));
  // never keep-all: one stopped reader would starve the others
  const std::int32_t depth = offered.depth == 0 ? 1000 : offered.depth;
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  // also what an earlier version recorded as volatile: services ask for it
  if (offered.is_transient_local || is_kept_for_restarts_only(info.name))
    keep_for_late_joiners(qos.get(), depth);
  if (offered.is_exclusive) {
    dds_qset_ownership(qos.get(), DDS_OWNERSHIP_EXCLUSIVE);
    dds_qset_ownership_strength(qos.get(), offered.ownership_strength);
  }
  if (offered.manual_liveliness_ns)
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, *offered.manual_liveliness_ns);
  set_partitions(offered, qos.get());
  const dds_data_representation_id_t representation = offered.representation;
  dds_qset_data_representation(qos.get(), 1, &representation);
  return qos;
}

}  // namespace

RawWriter::RawWriter(const Participant& participant, std::shared_ptr<const RawTopic> topic,
                     const OfferedQos& offered)
    : RawWriter(participant, topic,
                create_opaque_topic(participant, topic, offered, Instances::kByKey), offered) {}

RawWriter::RawWriter(const Participant& participant, std::shared_ptr<const RawTopic> topic,
                     OpaqueTopic opaque, const OfferedQos& offered)
    : WriterBase(participant, topic->info(), std::move(opaque.entity),
                 qos_for(topic->info(), offered).get()),
      raw_topic_(std::move(topic)),
      type_(opaque.type) {}

RawWriteResult RawWriter::write(const RawSample& sample) {
  if (sample.cdr.size() < kCdrHeaderBytes) return RawWriteResult::kMalformed;
  const ddsrt_iovec_t bytes = {const_cast<std::uint8_t*>(sample.cdr.data()), sample.cdr.size()};
  ddsi_serdata* const made =
      ddsi_serdata_from_ser_iov(type_, SDK_DATA, 1, &bytes, sample.cdr.size());
  if (made == nullptr) return RawWriteResult::kMalformed;
  made->timestamp.v = sample.source_time_ns;
  made->statusinfo = 0;
  const std::int32_t code = dds_forwardcdr(handle(), made);  // takes the sample over
  return written(code) == WriteResult::kWritten ? RawWriteResult::kWritten
                                                : RawWriteResult::kTimedOut;
}

}  // namespace slammot::dds
