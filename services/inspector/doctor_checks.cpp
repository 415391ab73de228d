#include "services/inspector/doctor_checks.hpp"

#include <algorithm>
#include <map>

#include "common/files/decimal.hpp"
#include "services/inspector/table_text.hpp"

namespace slammot::inspector {
namespace {

/// Room for a burst of the tiles of one submap, 16 of 128 kB. With 208 KiB such a burst took 4,000
/// times as long.
constexpr std::int64_t kReceiveBufferBytes = 2'097'152;
constexpr double kLeastFree_gb = 1.0;
/// Clocks of two computers order no samples, but age and latency are measured with them.
constexpr double kLargestClockError_ms = 10.0;

Finding receive_buffer(const Computer& computer) {
  Finding finding{"receive buffer", true, "not told", ""};
  if (!computer.receive_buffer_bytes) return finding;
  finding.text = "at most " + std::to_string(*computer.receive_buffer_bytes / 1024) + " KiB";
  finding.is_good = *computer.receive_buffer_bytes >= kReceiveBufferBytes;
  if (!finding.is_good)
    finding.advice = "sysctl -w net.core.rmem_max=" + std::to_string(kReceiveBufferBytes) +
                     " (for good: a file in /etc/sysctl.d): bursts of map tiles are lost";
  return finding;
}

Finding network(const Computer& computer) {
  std::string up;
  int count = 0;
  for (const NetworkInterface& one : computer.interfaces) {
    if (!one.is_up || one.is_loopback) continue;
    up += (up.empty() ? "" : ", ") + one.name;
    ++count;
  }
  if (count == 0)
    return {"interface", true, "loopback only",
            "services on this computer reach each other; for others bring an interface up"};
  if (count == 1) return {"interface", true, up, ""};
  return {"interface", true, up,
          "name the one to use in CYCLONEDDS_URI, <NetworkInterface name=\"...\"/>: otherwise DDS "
          "chooses one"};
}

Finding multicast(const Computer& computer) {
  if (computer.receives_multicast) return {"multicast", true, "works", ""};
  return {"multicast", false, "a datagram to 239.255.0.1 did not come back",
          "allow multicast on the interface, or list the computers as <Peers> with "
          "<AllowMulticast>false</AllowMulticast> in CYCLONEDDS_URI"};
}

Finding clock_finding(const Computer& computer) {
  Finding finding{"clock", true, "not told", ""};
  if (!computer.clock) return finding;
  finding.text = computer.clock->is_synchronised
                     ? "synchronised within " +
                           files::fixed_text(computer.clock->estimated_error_ms, 1) + " ms"
                     : "not synchronised";
  finding.is_good = computer.clock->is_synchronised &&
                    computer.clock->estimated_error_ms <= kLargestClockError_ms;
  if (!finding.is_good)
    finding.advice =
        "run chrony or systemd-timesyncd: ages and latencies between computers mean nothing "
        "otherwise; on one computer nothing depends on it";
  return finding;
}

Finding disk(const Computer& computer) {
  const DiskRoom& room = computer.state_disk;
  if (!room.fault.empty())
    return {"disk", false, room.fault,
            "choose another --state-dir or make room: without it a crash loses map and pose"};
  const bool is_enough = room.free_gb >= kLeastFree_gb;
  return {"disk", is_enough, files::fixed_text(room.free_gb, 1) + " GB free for state",
          is_enough ? "" : "make room: maps and recordings grow"};
}

Finding governor(const Computer& computer) {
  std::string names;
  for (const std::string& name : computer.governors) names += (names.empty() ? "" : ", ") + name;
  if (names.empty()) return {"CPU governor", true, "not adjustable here", ""};
  const bool is_slow = std::ranges::any_of(computer.governors, [](const std::string& name) {
    return name == "powersave" || name == "conservative" || name == "userspace";
  });
  return {"CPU governor", !is_slow, names,
          is_slow ? "cpupower frequency-set -g performance: slow clocks add latency" : ""};
}

bool is_ours(const dds::Peer& peer) { return peer.name.starts_with("slammot-"); }

}  // namespace

std::vector<Finding> findings_of(const Computer& computer) {
  return {receive_buffer(computer), network(computer), multicast(computer),
          clock_finding(computer),  disk(computer),    governor(computer)};
}

Finding finding_of_domain(std::uint32_t domain_id, const std::vector<dds::Peer>& peers) {
  std::map<std::string, int> ours, others;
  for (const dds::Peer& peer : peers) ++(is_ours(peer) ? ours : others)[peer.name];
  const auto list = [](const std::map<std::string, int>& names) {
    std::string text;
    for (const auto& [name, count] : names)
      text += (text.empty() ? "" : ", ") + name +
              (count > 1 ? " (" + std::to_string(count) + " times)" : "");
    return text;
  };
  const std::string number = std::to_string(domain_id);
  if (!others.empty())
    return {"domain", false, "domain " + number + " is shared with " + list(others),
            "choose another one: --domain or SLAMMOT_DOMAIN"};
  if (ours.empty()) return {"domain", true, "nobody is in domain " + number, ""};
  return {"domain", true, "in domain " + number + ": " + list(ours),
          "of one vehicle, localization, detection and tracking run once; others stand by"};
}

std::string findings_text(const std::vector<Finding>& findings) {
  std::vector<std::vector<std::string>> rows;
  for (const Finding& finding : findings) {
    rows.push_back({finding.what, finding.is_good ? "good" : "CHANGE", finding.text});
    if (!finding.advice.empty())
      rows.push_back({"", finding.is_good ? "note" : "do", finding.advice});
  }
  return table_text({"check", "", "found"}, rows, 3);
}

}  // namespace slammot::inspector
