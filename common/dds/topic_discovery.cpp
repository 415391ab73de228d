#include "common/dds/topic_discovery.hpp"

#include <dds/ddsi/ddsi_serdata.h>  // before the next one, which needs it
#include <dds/ddsi/ddsi_typelib.h>

#include "common/dds/builtin_topic.hpp"
#include "common/dds/endpoint_qos.hpp"
#include "common/dds/topic_table.hpp"

namespace slammot::dds {
namespace {

std::shared_ptr<const ddsi_typeinfo> copy_of(const dds_typeinfo_t* information) {
  if (information == nullptr) return nullptr;
  return {ddsi_typeinfo_dup(information), [](ddsi_typeinfo* copy) {
            ddsi_typeinfo_fini(copy);
            dds_free(copy);
          }};
}

OfferedQos qos_offered_by(const dds_builtintopic_endpoint_t& writer) {
  OfferedQos offered = offered_qos_of(writer.qos);
  if (is_kept_for_restarts_only(writer.topic_name)) offered.is_transient_local = false;
  return offered;
}

}  // namespace

TopicDiscovery::TopicDiscovery(const Participant& participant)
    : own_participant_(0),
      publications_(builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION)) {
  check(dds_get_instance_handle(participant.handle(), &own_participant_),
        "dds_get_instance_handle");
}

std::vector<FoundWriter> TopicDiscovery::take() {
  std::vector<FoundWriter> found;
  take_each<dds_builtintopic_endpoint_t>(
      publications_.handle(), [&](auto& endpoint, const dds_sample_info_t& info) {
        const bool joined = info.valid_data && info.instance_state == DDS_IST_ALIVE &&
                            endpoint.qos != nullptr &&
                            endpoint.participant_instance_handle != own_participant_;
        if (!joined) return;
        found.push_back({endpoint.topic_name, endpoint.type_name, qos_offered_by(endpoint),
                         copy_of(type_information(endpoint))});
      });
  return found;
}

}  // namespace slammot::dds
