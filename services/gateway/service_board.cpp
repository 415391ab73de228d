#include "services/gateway/service_board.hpp"

#include <unistd.h>

#include <cmath>
#include <fstream>

#include "services/gateway/json_parts.hpp"

namespace slammot::gateway {
namespace {

double seconds_between(ServiceBoard::Time from, ServiceBoard::Time to) {
  return std::chrono::duration<double>(to - from).count();
}

std::string label_of(const ServiceBoard::Entry& entry) {
  return entry.instance.empty() || entry.instance == "main" ? entry.service
                                                            : entry.service + " " + entry.instance;
}

Json status_json(const wire::ServiceStatus& status) {
  Json json = {
      {"version", status.version},         {"started_ns", std::to_string(status.started_ns)},
      {"explanation", status.explanation}, {"counters", Json::object()},
      {"latencies", Json::array()},        {"missing", Json::array()}};
  for (const wire::Counter& counter : status.counters)
    json["counters"][counter.name] = counter.total;
  for (const wire::StageLatency& latency : status.latencies)
    json["latencies"].push_back({{"stage", latency.stage},
                                 {"calls", latency.calls},
                                 {"p50_ms", latency.p50_ms},
                                 {"p99_ms", latency.p99_ms},
                                 {"highest_ms", latency.highest_ms}});
  for (const wire::MissingInput& missing : status.missing_inputs)
    json["missing"].push_back({{"topic", missing.topic}, {"silent_s", missing.silent_s}});
  return json;
}

Json entry_json(const ServiceBoard::Entry& entry, ServiceBoard::Time now) {
  Json json = entry.status ? status_json(*entry.status) : Json::object();
  json["service"] = entry.service;
  json["instance"] = entry.instance;
  json["state"] = entry.is_silent(now) ? "silent" : wire::to_string(entry.state);
  json["age_s"] = seconds_between(entry.last_beat, now);
  return json;
}

}  // namespace

void ServiceBoard::take(const wire::Heartbeat& heartbeat, Time now) {
  Entry& entry = entries_[{heartbeat.name.service, heartbeat.name.instance}];
  entry.service = heartbeat.name.service;
  entry.instance = heartbeat.name.instance;
  entry.state = heartbeat.state;
  entry.last_beat = now;
  entry.started_ns = heartbeat.started_ns;
  entry.process_number = heartbeat.process_number;
  forget_earlier_role_of(entry);
}

/// A standby that leads has another name from then on.
void ServiceBoard::forget_earlier_role_of(const Entry& entry) {
  std::erase_if(entries_, [&](const auto& named) {
    const Entry& other = named.second;
    return other.service == entry.service && other.instance != entry.instance &&
           other.started_ns == entry.started_ns && other.process_number == entry.process_number;
  });
}

/// A retained status may be of a service that died long ago: only heartbeats tell its age.
void ServiceBoard::take(const wire::ServiceStatus& status, Time now) {
  const auto [found, is_new] = entries_.try_emplace({status.name.service, status.name.instance});
  Entry& entry = found->second;
  if (is_new) {
    entry.service = status.name.service;
    entry.instance = status.name.instance;
    entry.last_beat = now;
    entry.started_ns = status.started_ns;
    entry.process_number = status.process_number;
  }
  entry.state = status.state;
  entry.status = status;
}

void ServiceBoard::forget(Time now) {
  std::erase_if(entries_, [&](const auto& item) {
    const Entry& entry = item.second;
    const bool has_stopped = entry.state == wire::ServiceState::kStopping;
    return entry.is_silent(now) && (has_stopped || now - entry.last_beat > kForgotten);
  });
}

std::vector<ServiceBoard::Entry> ServiceBoard::entries() const {
  std::vector<Entry> list;
  for (const auto& [key, entry] : entries_) list.push_back(entry);
  return list;
}

std::vector<std::string> ServiceBoard::warnings(Time now) const {
  std::vector<std::string> warnings;
  for (const auto& [key, entry] : entries_) {
    if (entry.is_silent(now))
      warnings.push_back(label_of(entry) + ": no sign of life for " +
                         std::to_string(std::lround(seconds_between(entry.last_beat, now))) + " s");
    else if (entry.state == wire::ServiceState::kDegraded)
      warnings.push_back(label_of(entry) + ": " +
                         (entry.status && !entry.status->explanation.empty()
                              ? entry.status->explanation
                              : std::string("degraded")));
  }
  return warnings;
}

std::string health_json(const ServiceBoard& board, const GatewayFigures& figures,
                        ServiceBoard::Time now) {
  Json json = {{"services", Json::array()},
               {"warnings", board.warnings(now)},
               {"gateway",
                {{"viewers", figures.viewers},
                 {"dropped_messages", figures.dropped_messages},
                 {"sent_bytes", figures.sent_bytes},
                 {"memory_mb", figures.memory_mb},
                 {"scan_age_s", figures.scan_age_s}}}};
  for (const ServiceBoard::Entry& entry : board.entries())
    json["services"].push_back(entry_json(entry, now));
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double resident_memory_mb() {
  std::ifstream file("/proc/self/statm");
  double pages = 0.0;
  double resident = 0.0;
  file >> pages >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

}  // namespace slammot::gateway
