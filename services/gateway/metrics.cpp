#include "services/gateway/metrics.hpp"

#include <limits>

#include <prometheus/metric_family.h>
#include <prometheus/text_serializer.h>

#include "common/app/version.hpp"

namespace slammot::gateway {
namespace {

using Labels = std::vector<prometheus::ClientMetric::Label>;
using Families = std::vector<prometheus::MetricFamily>;
using prometheus::MetricType;

prometheus::MetricFamily family(std::string name, std::string help, MetricType type) {
  prometheus::MetricFamily result;
  result.name = std::move(name);
  result.help = std::move(help);
  result.type = type;
  return result;
}

void add(prometheus::MetricFamily& to, Labels labels, double value) {
  prometheus::ClientMetric metric;
  metric.label = std::move(labels);
  metric.counter.value = value;
  metric.gauge.value = value;
  to.metric.push_back(std::move(metric));
}

Labels labels_of(const ServiceBoard::Entry& entry) {
  return {{"service", entry.service}, {"instance_name", entry.instance}};
}

Labels with(Labels labels, const std::string& name, const std::string& value) {
  labels.push_back({name, value});
  return labels;
}

bool is_up(const ServiceBoard::Entry& entry, ServiceBoard::Time now) {
  return !entry.is_silent(now) && (entry.state == wire::ServiceState::kRunning ||
                                   entry.state == wire::ServiceState::kDegraded);
}

void add_service_states(const ServiceBoard& board, ServiceBoard::Time now, Families& families) {
  auto up =
      family("slammot_service_up", "1 if the service runs, degraded or not.", MetricType::Gauge);
  auto degraded = family("slammot_service_degraded",
                         "1 if the service lacks an input or reports a fault.", MetricType::Gauge);
  auto age = family("slammot_service_heartbeat_age_seconds", "Time since the last heartbeat.",
                    MetricType::Gauge);
  for (const ServiceBoard::Entry& entry : board.entries()) {
    add(up, labels_of(entry), is_up(entry, now) ? 1.0 : 0.0);
    add(degraded, labels_of(entry), entry.state == wire::ServiceState::kDegraded ? 1.0 : 0.0);
    add(age, labels_of(entry), std::chrono::duration<double>(now - entry.last_beat).count());
  }
  families.insert(families.end(), {up, degraded, age});
}

void add_service_counters(const ServiceBoard& board, Families& families) {
  auto counts = family("slammot_service_events_total", "Counters of the services, by name.",
                       MetricType::Counter);
  for (const ServiceBoard::Entry& entry : board.entries()) {
    if (!entry.status) continue;
    for (const wire::Counter& counter : entry.status->counters)
      add(counts, with(labels_of(entry), "event", counter.name),
          static_cast<double>(counter.total));
  }
  families.push_back(counts);
}

void add_stage_times(const ServiceBoard& board, Families& families) {
  auto times = family("slammot_stage_duration_seconds", "Time of one call of a stage: quantiles.",
                      MetricType::Gauge);
  auto calls = family("slammot_stage_calls_total", "Calls of a stage.", MetricType::Counter);
  for (const ServiceBoard::Entry& entry : board.entries()) {
    if (!entry.status) continue;
    for (const wire::StageLatency& latency : entry.status->latencies) {
      const Labels labels = with(labels_of(entry), "stage", latency.stage);
      add(times, with(labels, "quantile", "0.5"), latency.p50_ms * 1e-3);
      add(times, with(labels, "quantile", "0.99"), latency.p99_ms * 1e-3);
      add(times, with(labels, "quantile", "1"), latency.highest_ms * 1e-3);
      add(calls, labels, static_cast<double>(latency.calls));
    }
  }
  families.insert(families.end(), {times, calls});
}

void add_figure(const char* name, const char* help, MetricType type, double value,
                Families& families) {
  auto figure = family(name, help, type);
  add(figure, {}, value);
  families.push_back(figure);
}

void add_gateway(const HubCounters& hub, const GatewayFigures& figures, Families& families) {
  const auto total = [&](const char* name, const char* help, std::uint64_t value) {
    add_figure(name, help, MetricType::Counter, static_cast<double>(value), families);
  };
  const auto gauge = [&](const char* name, const char* help, double value) {
    add_figure(name, help, MetricType::Gauge, value, families);
  };
  gauge("slammot_gateway_connections", "Open connections.", static_cast<double>(hub.connections));
  gauge("slammot_gateway_viewers", "Open WebSockets.", static_cast<double>(hub.viewers));
  gauge("slammot_gateway_scan_age_seconds",
        "Time since the last localized scan; infinite: none came.",
        figures.scan_age_s < 0.0 ? std::numeric_limits<double>::infinity() : figures.scan_age_s);
  auto build = family("slammot_build_info", "1; its labels tell the version.", MetricType::Gauge);
  add(build, {{"version", std::string(app::kVersion)}}, 1.0);
  families.push_back(build);
  gauge("process_resident_memory_bytes", "Resident memory of the gateway.",
        figures.memory_mb * 1024.0 * 1024.0);
  total("slammot_gateway_sent_bytes_total", "Sent over WebSockets.", hub.sent_bytes);
  total("slammot_gateway_sent_messages_total", "Sent over WebSockets.", hub.sent_messages);
  total("slammot_gateway_dropped_messages_total", "Dropped for viewers that are too slow.",
        hub.dropped_messages);
  total("slammot_gateway_refused_messages_total", "From viewers, not understood.",
        hub.refused_messages);
  total("slammot_gateway_refused_connections_total", "Without token, or too many.",
        hub.refused_connections);
}

}  // namespace

std::string metrics_text(const std::string& vehicle_id, const ServiceBoard& board,
                         const HubCounters& hub, const GatewayFigures& figures,
                         ServiceBoard::Time now) {
  Families families;
  add_service_states(board, now, families);
  add_service_counters(board, families);
  add_stage_times(board, families);
  add_gateway(hub, figures, families);
  for (prometheus::MetricFamily& each : families) {
    for (prometheus::ClientMetric& metric : each.metric)
      metric.label.push_back({"vehicle", vehicle_id});
  }
  return prometheus::TextSerializer().Serialize(families);
}

}  // namespace slammot::gateway
