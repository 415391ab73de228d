#include "services/inspector/qos_report.hpp"

namespace slammot::inspector {
namespace {

std::vector<dds::RemoteEndpoint> endpoints_of(const dds::Discovery& discovery,
                                              const std::string& topic, bool are_writers) {
  std::vector<dds::RemoteEndpoint> found;
  for (const auto& [guid, endpoint] : discovery.endpoints()) {
    if (endpoint.topic == topic && endpoint.is_writer == are_writers) found.push_back(endpoint);
  }
  return found;
}

/// Types of one name and different content: another version of the program.
bool differ_in_version(const dds::RemoteEndpoint& a, const dds::RemoteEndpoint& b) {
  return a.type == b.type && !a.type_hash.empty() && !b.type_hash.empty() &&
         a.type_hash != b.type_hash;
}

}  // namespace

std::vector<std::string> obstacles(const dds::RemoteEndpoint& writer,
                                   const dds::RemoteEndpoint& reader) {
  std::vector<std::string> reasons = dds::incompatibilities(writer.qos, reader.qos);
  if (writer.type != reader.type)
    reasons.push_back("type: the writer has " + writer.type + ", the reader " + reader.type);
  return reasons;
}

std::string name_of(const dds::Peer& peer) {
  const std::string place = peer.host +
                            (peer.host.empty() || peer.process_number.empty() ? "" : " ") +
                            peer.process_number;
  return peer.name + (place.empty() ? "" : " (" + place + ")");
}

std::vector<Mismatch> mismatches(const dds::Discovery& discovery, const std::string& topic) {
  std::vector<Mismatch> found;
  for (const dds::RemoteEndpoint& writer : endpoints_of(discovery, topic, true)) {
    for (const dds::RemoteEndpoint& reader : endpoints_of(discovery, topic, false)) {
      auto reasons = obstacles(writer, reader);
      if (!reasons.empty()) found.push_back({writer, reader, std::move(reasons)});
    }
  }
  return found;
}

std::string qos_report(const dds::Discovery& discovery, const std::string& topic) {
  std::string text = topic + "\n";
  for (const bool are_writers : {true, false}) {
    for (const dds::RemoteEndpoint& endpoint : endpoints_of(discovery, topic, are_writers)) {
      text += std::string(are_writers ? "  writer  " : "  reader  ") +
              name_of(discovery.peer_of(endpoint)) + ": " + endpoint.qos.text() + "\n";
    }
  }
  for (const Mismatch& mismatch : mismatches(discovery, topic)) {
    text += "  not connected: " + name_of(discovery.peer_of(mismatch.writer)) + " to " +
            name_of(discovery.peer_of(mismatch.reader)) + "\n";
    for (const std::string& reason : mismatch.reasons) text += "    " + reason + "\n";
  }
  for (const dds::RemoteEndpoint& writer : endpoints_of(discovery, topic, true)) {
    for (const dds::RemoteEndpoint& reader : endpoints_of(discovery, topic, false)) {
      if (differ_in_version(writer, reader))
        text += "  other version of " + writer.type + ": " + name_of(discovery.peer_of(writer)) +
                " and " + name_of(discovery.peer_of(reader)) +
                "; they are connected only if one type extends the other\n";
    }
  }
  return text;
}

}  // namespace slammot::inspector
