#pragma once

#include <array>
#include <cstddef>

#include <dds/dds.h>

#include "common/dds/entity.hpp"
#include "common/dds/participant.hpp"

namespace slammot::dds {

/// Reader of a topic by which the C library tells of participants and endpoints; only for the
/// sources of this folder.
inline Entity builtin_reader(const Participant& participant, dds_entity_t topic) {
  return {dds_create_reader(participant.handle(), topic, nullptr, nullptr),
          "reader of a built-in topic"};
}

/// Calls handle(sample, info) for each sample that waits. True if there was one.
template <typename Sample, typename Handle>
bool take_each(Entity::Handle reader, Handle handle) {
  constexpr std::size_t kAtOnce = 32;
  std::array<void*, kAtOnce> samples{};
  std::array<dds_sample_info_t, kAtOnce> infos;
  bool any = false;
  for (;;) {
    const dds_return_t count =
        check(dds_take(reader, samples.data(), infos.data(), kAtOnce, kAtOnce), "dds_take");
    if (count == 0) return any;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      handle(*static_cast<Sample*>(samples[i]), infos[i]);
    any = true;
    dds_return_loan(reader, samples.data(), count);
  }
}

}  // namespace slammot::dds
