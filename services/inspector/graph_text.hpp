#pragma once

#include <set>
#include <string>
#include <vector>

#include "common/dds/discovery.hpp"

namespace slammot::inspector {

/// A process that writes topics that another one reads.
struct Link {
  std::string from, to;  ///< Names of processes.
  std::string topic;
  bool is_connected = true;  ///< False where QoS or type keep them apart.
  auto operator<=>(const Link&) const = default;
};

/// Who talks to whom. Processes of one name are told apart by their numbers.
/// `with_status`: with heartbeats, statuses, commands and replies, which connect all with all.
std::set<Link> links(const dds::Discovery& discovery, bool with_status);

/// One line a pair of processes, with its topics.
std::string graph_text(const std::set<Link>& links);

/// For Graphviz' `dot`.
std::string graph_dot(const std::set<Link>& links);

}  // namespace slammot::inspector
