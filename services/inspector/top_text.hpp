#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/wire/service.hpp"
#include "services/inspector/topic_meter.hpp"

namespace slammot::inspector {

/// A line of the table of topics.
struct TopicLine {
  std::string topic;
  TopicFigures figures;
  double age_s = -1.0;  ///< Negative: nothing came yet.
  std::uint32_t lost = 0;
  int writers = 0, readers = 0;
};

/// Services with the latencies of their stages; below each the reason of its state and the counters
/// of what was dropped.
std::string services_text(const std::vector<wire::ServiceStatus>& services, std::int64_t now_ns);

std::string topics_text(const std::vector<TopicLine>& topics);

/// True if a counter of this name counts something that was lost, refused or faulty.
bool counts_a_loss(const std::string& counter);

}  // namespace slammot::inspector
