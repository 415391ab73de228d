#include "common/dds/discovery.hpp"

#include <algorithm>
#include <cstdio>
#include <thread>

#include <dds/dds.h>

#include "common/dds/builtin_topic.hpp"
#include "common/dds/endpoint_qos.hpp"

namespace slammot::dds {
namespace {

RemoteEndpoint::Guid guid_of(const dds_guid_t& guid) {
  std::string text;
  for (const std::uint8_t byte : guid.v) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

std::string property(const dds_qos_t* qos, const char* name) {
  char* value = nullptr;
  if (!dds_qget_prop(qos, name, &value) || value == nullptr) return {};
  const std::string text = value;
  dds_free(value);
  return text;
}

std::string entity_name(const dds_qos_t* qos) {
  char* value = nullptr;
  if (!dds_qget_entity_name(qos, &value) || value == nullptr) return {};
  const std::string text = value;
  dds_free(value);
  return text;
}

Peer peer_of_sample(const dds_builtintopic_participant_t& sample) {
  Peer peer{entity_name(sample.qos), property(sample.qos, "__Hostname"),
            property(sample.qos, "__Pid")};
  if (peer.name.empty()) peer.name = property(sample.qos, "__ProcessName");
  if (peer.name.empty()) peer.name = "unnamed";
  return peer;
}

RemoteEndpoint endpoint_of(dds_builtintopic_endpoint_t& sample, bool is_writer) {
  return {guid_of(sample.key), guid_of(sample.participant_key), is_writer,        sample.topic_name,
          sample.type_name,    endpoint_qos(sample.qos),        type_hash(sample)};
}

RemoteEndpoint::Guid guid_of(const Participant& participant) {
  dds_guid_t guid;
  check(dds_get_guid(participant.handle(), &guid), "dds_get_guid");
  return guid_of(guid);
}

}  // namespace

Discovery::Discovery(const Participant& participant)
    : own_(guid_of(participant)),
      participants_(builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT)),
      publications_(builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION)),
      subscriptions_(builtin_reader(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION)) {}

Discovery::~Discovery() = default;

bool Discovery::take_participants() {
  return take_each<dds_builtintopic_participant_t>(
      participants_.handle(), [this](const auto& sample, const dds_sample_info_t& info) {
        if (info.instance_state == DDS_IST_ALIVE)
          peers_[guid_of(sample.key)] = peer_of_sample(sample);
        else peers_.erase(guid_of(sample.key));
      });
}

bool Discovery::take_endpoints(Entity::Handle reader, bool are_writers) {
  return take_each<dds_builtintopic_endpoint_t>(
      reader, [&](auto& sample, const dds_sample_info_t& info) {
        if (info.instance_state != DDS_IST_ALIVE) {
          endpoints_.erase(guid_of(sample.key));
        } else if (guid_of(sample.participant_key) != own_) {
          RemoteEndpoint endpoint = endpoint_of(sample, are_writers);
          endpoints_.insert_or_assign(endpoint.guid, std::move(endpoint));
        }
      });
}

bool Discovery::update() {
  bool any = take_participants();
  any |= take_endpoints(publications_.handle(), true);
  any |= take_endpoints(subscriptions_.handle(), false);
  return any;
}

void Discovery::settle(std::chrono::milliseconds quiet, std::chrono::milliseconds longest) {
  const auto start = std::chrono::steady_clock::now();
  auto last_change = start;
  for (auto now = start; now - start < longest && now - last_change < quiet;
       now = std::chrono::steady_clock::now()) {
    if (update()) last_change = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

Peer Discovery::peer_of(const RemoteEndpoint& endpoint) const {
  const auto peer = peers_.find(endpoint.participant);
  return peer == peers_.end() ? Peer{"unknown", "", ""} : peer->second;
}

}  // namespace slammot::dds
