#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/dds/discovery.hpp"
#include "services/inspector/computer.hpp"

namespace slammot::inspector {

/// Result of one check of the computer.
struct Finding {
  std::string what;  ///< E.g. "receive buffer".
  bool is_good = true;
  std::string text;    ///< What was found.
  std::string advice;  ///< What to change; empty where nothing is.
};

/// Checks of the computer; all findings, good ones too.
std::vector<Finding> findings_of(const Computer& computer);

/// Whether others use the domain: programs that are not of slammot, and the services of slammot
/// that run already.
Finding finding_of_domain(std::uint32_t domain_id, const std::vector<dds::Peer>& peers);

/// A line for each, and one for each advice.
std::string findings_text(const std::vector<Finding>& findings);

}  // namespace slammot::inspector
