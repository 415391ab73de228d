#include "common/dds/wait_set.hpp"

#include <algorithm>
#include <bitset>
#include <thread>
#include <utility>

#include <dds/dds.h>

namespace slammot::dds {
namespace {

constexpr std::size_t kMostInOrder = 64;

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
  if (gathering_.count() > 0) std::this_thread::sleep_for(gathering_);
  // Looks at the last one first: where it has samples, those that were written before them for
  // earlier handlers are seen, too, even if all arrive meanwhile.
  std::bitset<kMostInOrder> has_data;
  for (std::size_t i = std::min(attached_.size(), kMostInOrder); i-- > 0;)
    has_data[i] = is_triggered(attached_[i].condition);
  for (std::size_t i = 0; i < attached_.size(); ++i) {
    if (i < kMostInOrder ? has_data[i] : is_triggered(attached_[i].condition))
      attached_[i].handler();
  }
  return Wake::kHandled;
}

void WaitSet::stop() {
  check(dds_set_guardcondition(stop_.handle(), true), "dds_set_guardcondition");
}

}  // namespace slammot::dds
