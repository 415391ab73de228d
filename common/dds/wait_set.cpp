#include "common/dds/wait_set.hpp"

#include <utility>

#include <dds/dds.h>

namespace slammot::dds {
namespace {

bool is_triggered(Entity::Handle condition) {
  return check(dds_triggered(condition), "dds_triggered") != 0;
}

}  // namespace

WaitSet::WaitSet(const Participant& participant)
    : wait_set_(dds_create_waitset(participant.handle()), "dds_create_waitset"),
      stop_(dds_create_guardcondition(participant.handle()), "dds_create_guardcondition") {
  check(dds_waitset_attach(wait_set_.handle(), stop_.handle(), 0), "dds_waitset_attach");
}

void WaitSet::on_data(const ReaderBase& reader, std::function<void()> handler) {
  const Entity::Handle condition = reader.data_available_.handle();
  check(dds_waitset_attach(wait_set_.handle(), condition, 0), "dds_waitset_attach");
  attached_.push_back({condition, std::move(handler)});
}

WaitSet::Wake WaitSet::wait(std::chrono::nanoseconds timeout) {
  const dds_return_t triggered =
      check(dds_waitset_wait(wait_set_.handle(), nullptr, 0, timeout.count()), "dds_waitset_wait");
  if (is_triggered(stop_.handle())) return Wake::kStopped;
  if (triggered == 0) return Wake::kTimedOut;
  for (const Attached& attached : attached_) {
    if (is_triggered(attached.condition)) attached.handler();
  }
  return Wake::kHandled;
}

void WaitSet::stop() {
  check(dds_set_guardcondition(stop_.handle(), true), "dds_set_guardcondition");
}

}  // namespace slammot::dds
