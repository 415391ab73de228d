#pragma once

#include <string>
#include <vector>

#include "common/dds/discovery.hpp"

namespace slammot::inspector {

/// A writer and a reader of one topic that are not connected.
struct Mismatch {
  dds::RemoteEndpoint writer, reader;
  std::vector<std::string> reasons;
};

/// Why DDS does not connect a writer and a reader of one topic, by their QoS and the names of their
/// types; empty if it does.
std::vector<std::string> obstacles(const dds::RemoteEndpoint& writer,
                                   const dds::RemoteEndpoint& reader);

/// All pairs of a writer and a reader of one topic that DDS does not connect. A different type is
/// reported where nothing else explains it: one that only has members more is connected all the
/// same.
std::vector<Mismatch> mismatches(const dds::Discovery& discovery, const std::string& topic);

/// Endpoints of a topic with their QoS, and what keeps pairs of them apart.
std::string qos_report(const dds::Discovery& discovery, const std::string& topic);

/// "slammot-localization (host 1234)".
std::string name_of(const dds::Peer& peer);

}  // namespace slammot::inspector
