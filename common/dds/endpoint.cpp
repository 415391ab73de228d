#include "common/dds/endpoint.hpp"

#include <dds/dds.h>

namespace slammot::dds {
namespace {

Entity create_topic(const Participant& participant, const TopicInfo& info) {
  const std::string name(info.name);
  return {dds_create_topic(participant.handle(), info.type, name.c_str(), nullptr, nullptr),
          "topic " + name};
}

}  // namespace

std::uint64_t Endpoint::instance_handle() const {
  dds_instance_handle_t instance = 0;
  check(dds_get_instance_handle(handle(), &instance), describe("dds_get_instance_handle"));
  return instance;
}

std::string QosMismatch::text() const {
  const std::string count = " (" + std::to_string(total) + " so far)";
  if (policy == "type")
    return topic_name + ": another participant's version of the type is incompatible" + count;
  return topic_name + ": cannot be connected with another participant's endpoint because of " +
         policy + count;
}

Endpoint::Endpoint(const Participant& participant, const TopicInfo& info, Side side,
                   const dds_qos* qos)
    : Endpoint(participant, info, create_topic(participant, info), side, qos) {}

Endpoint::Endpoint(const Participant& participant, const TopicInfo& info, Entity topic, Side side,
                   const dds_qos* qos)
    : info_(&info), topic_(std::move(topic)) {
  const std::string name(info.name);
  const bool reads = side == Side::kReader;
  entity_ = reads ? Entity(dds_create_reader(participant.handle(), topic_.handle(), qos, nullptr),
                           "reader of " + name)
                  : Entity(dds_create_writer(participant.handle(), topic_.handle(), qos, nullptr),
                           "writer of " + name);
  const std::uint32_t others_come_and_go =
      reads ? DDS_SUBSCRIPTION_MATCHED_STATUS | DDS_REQUESTED_INCOMPATIBLE_QOS_STATUS
            : DDS_PUBLICATION_MATCHED_STATUS | DDS_OFFERED_INCOMPATIBLE_QOS_STATUS;
  check(dds_set_status_mask(handle(), others_come_and_go), describe("dds_set_status_mask"));
}

std::string Endpoint::describe(const char* call) const {
  return std::string(info_->name) + ": " + call;
}

bool Endpoint::wait_until(const std::function<bool()>& enough,
                          std::chrono::nanoseconds timeout) const {
  const Entity waitset(dds_create_waitset(dds_get_participant(handle())),
                       describe("dds_create_waitset"));
  check(dds_waitset_attach(waitset.handle(), handle(), 0), describe("dds_waitset_attach"));
  const dds_time_t deadline = dds_time() + timeout.count();
  while (!enough()) {
    if (check(dds_waitset_wait_until(waitset.handle(), nullptr, 0, deadline),
              describe("dds_waitset_wait")) == 0) {
      return enough();
    }
  }
  return true;
}

std::optional<QosMismatch> Endpoint::mismatch(std::uint32_t total,
                                              std::uint32_t last_policy_id) const {
  if (total == 0) return std::nullopt;
  return QosMismatch{std::string(info_->name), qos_policy_name(last_policy_id), total};
}

}  // namespace slammot::dds
