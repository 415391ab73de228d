#include "services/inspector/graph_text.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "services/inspector/qos_report.hpp"

namespace slammot::inspector {
namespace {

constexpr std::array<std::string_view, 4> kStatusTopics = {"slammot/heartbeat", "slammot/status",
                                                           "slammot/command", "slammot/reply"};

bool is_of_status(const std::string& topic) {
  return std::ranges::find(kStatusTopics, topic) != kStatusTopics.end();
}

/// By participant: the name, with host and number where several have it.
std::map<std::string, std::string> names_of_peers(const dds::Discovery& discovery) {
  std::map<std::string, int> count;
  for (const auto& [guid, peer] : discovery.peers()) ++count[peer.name];
  std::map<std::string, std::string> names;
  for (const auto& [guid, peer] : discovery.peers())
    names[guid] = count[peer.name] > 1 ? name_of(peer) : peer.name;
  return names;
}

std::string short_name(const std::string& topic) {
  return topic.starts_with("slammot/") ? topic.substr(8) : topic;
}

std::string label_of(const Link& link) {
  return short_name(link.topic) + (link.is_connected ? "" : " (NOT CONNECTED)");
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

/// Topics by pair of processes.
std::map<std::pair<std::string, std::string>, std::vector<Link>> by_pair(
    const std::set<Link>& links) {
  std::map<std::pair<std::string, std::string>, std::vector<Link>> pairs;
  for (const Link& link : links) pairs[{link.from, link.to}].push_back(link);
  return pairs;
}

}  // namespace

std::set<Link> links(const dds::Discovery& discovery, bool with_status) {
  const auto names = names_of_peers(discovery);
  const auto name = [&](const dds::RemoteEndpoint& endpoint) {
    const auto known = names.find(endpoint.participant);
    return known == names.end() ? "unknown" : known->second;
  };
  std::set<Link> found;
  for (const auto& [writer_guid, writer] : discovery.endpoints()) {
    if (!writer.is_writer || (!with_status && is_of_status(writer.topic))) continue;
    for (const auto& [reader_guid, reader] : discovery.endpoints()) {
      if (reader.is_writer || reader.topic != writer.topic) continue;
      if (reader.participant == writer.participant) continue;
      found.insert({name(writer), name(reader), writer.topic, obstacles(writer, reader).empty()});
    }
  }
  return found;
}

std::string graph_text(const std::set<Link>& links) {
  std::string text;
  for (const auto& [pair, topics] : by_pair(links)) {
    text += pair.first + " -> " + pair.second + ": ";
    for (std::size_t i = 0; i < topics.size(); ++i)
      text += (i == 0 ? "" : ", ") + label_of(topics[i]);
    text += "\n";
  }
  return text;
}

std::string graph_dot(const std::set<Link>& links) {
  std::string text =
      "digraph bus {\n  rankdir=LR;\n  node [shape=box, fontname=sans];\n"
      "  edge [fontname=sans, fontsize=9];\n";
  for (const auto& [pair, topics] : by_pair(links)) {
    std::string label;
    bool is_connected = true;
    for (const Link& link : topics) {
      label += (label.empty() ? "" : "\\n") + label_of(link);
      is_connected = is_connected && link.is_connected;
    }
    text += "  " + quoted(pair.first) + " -> " + quoted(pair.second) + " [label=\"" + label + "\"" +
            (is_connected ? "" : ", color=red") + "];\n";
  }
  return text + "}\n";
}

}  // namespace slammot::inspector
