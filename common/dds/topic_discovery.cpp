#include "common/dds/topic_discovery.hpp"

#include <array>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>  // before the next one, which needs it
#include <dds/ddsi/ddsi_typelib.h>

namespace slammot::dds {
namespace {

std::shared_ptr<const ddsi_typeinfo> information_of(dds_builtintopic_endpoint_t& endpoint) {
  const dds_typeinfo_t* lent = nullptr;
  if (dds_builtintopic_get_endpoint_type_info(&endpoint, &lent) != DDS_RETCODE_OK ||
      lent == nullptr || !ddsi_typeinfo_present(lent))
    return nullptr;
  return {ddsi_typeinfo_dup(lent), [](ddsi_typeinfo* information) {
            ddsi_typeinfo_fini(information);
            dds_free(information);
          }};
}

}  // namespace

TopicDiscovery::TopicDiscovery(const Participant& participant)
    : own_participant_(0),
      publications_(dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPUBLICATION,
                                      nullptr, nullptr),
                    "reader of the bus' writers") {
  check(dds_get_instance_handle(participant.handle(), &own_participant_),
        "dds_get_instance_handle");
}

std::vector<FoundWriter> TopicDiscovery::take() {
  constexpr std::size_t kAtOnce = 32;
  std::vector<FoundWriter> found;
  for (;;) {
    std::array<void*, kAtOnce> samples{};
    std::array<dds_sample_info_t, kAtOnce> infos;
    const dds_return_t count =
        check(dds_take(publications_.handle(), samples.data(), infos.data(), kAtOnce, kAtOnce),
              "dds_take of the bus' writers");
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      auto& endpoint = *static_cast<dds_builtintopic_endpoint_t*>(samples[i]);
      const bool joined = infos[i].valid_data && infos[i].instance_state == DDS_IST_ALIVE &&
                          endpoint.qos != nullptr;
      if (!joined || endpoint.participant_instance_handle == own_participant_) continue;
      found.push_back({endpoint.topic_name, endpoint.type_name, offered_qos_of(endpoint.qos),
                       information_of(endpoint)});
    }
    if (count > 0) dds_return_loan(publications_.handle(), samples.data(), count);
    if (count < static_cast<dds_return_t>(kAtOnce)) return found;
  }
}

}  // namespace slammot::dds
