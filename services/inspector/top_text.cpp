#include "services/inspector/top_text.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/files/decimal.hpp"
#include "services/inspector/table_text.hpp"

namespace slammot::inspector {
namespace {

constexpr std::array<std::string_view, 15> kLosses = {
    "faulty",    "stray",   "duplicate", "out_of_order", "lost",
    "dropped",   "failed",  "far_ahead", "incompatible", "skipped",
    "malformed", "foreign", "missed",    "slow_readers", "scans_of_earlier_drives"};

std::string state_of(const wire::ServiceStatus& service) {
  return service.stands_by ? "standby" : std::string(wire::to_string(service.state));
}

std::string duration_text(std::int64_t duration_ns) {
  const std::int64_t seconds = duration_ns / 1'000'000'000;
  if (seconds < 120) return std::to_string(seconds) + " s";
  return seconds < 7200 ? std::to_string(seconds / 60) + " min"
                        : std::to_string(seconds / 3600) + " h";
}

std::string losses_of(const wire::ServiceStatus& service) {
  std::string text;
  for (const wire::Counter& counter : service.counters) {
    if (counter.total > 0 && counts_a_loss(counter.name))
      text += (text.empty() ? "" : ", ") + counter.name + " " + std::to_string(counter.total);
  }
  return text;
}

std::string name_of(const wire::ServiceStatus& service) {
  return service.name.vehicle_id + " " + service.name.service +
         (service.name.instance == "main" ? "" : " " + service.name.instance);
}

}  // namespace

bool counts_a_loss(const std::string& counter) {
  return std::ranges::any_of(
      kLosses, [&](std::string_view part) { return counter.find(part) != std::string::npos; });
}

std::string services_text(const std::vector<wire::ServiceStatus>& services, std::int64_t now_ns) {
  std::vector<std::vector<std::string>> rows;
  std::string remarks;
  for (const wire::ServiceStatus& service : services) {
    std::vector<std::string> row = {name_of(service), state_of(service),
                                    std::to_string(service.process_number),
                                    duration_text(now_ns - service.started_ns)};
    for (const wire::StageLatency& stage : service.latencies) {
      row.insert(row.end(),
                 {stage.stage, std::to_string(stage.calls), files::fixed_text(stage.p50_ms, 2),
                  files::fixed_text(stage.p99_ms, 2), files::fixed_text(stage.highest_ms, 2)});
      rows.push_back(std::move(row));
      row = {"", "", "", ""};
    }
    if (!row.front().empty()) rows.push_back(std::move(row));
    if (!service.explanation.empty())
      remarks += "  " + name_of(service) + ": " + service.explanation + "\n";
    if (const std::string losses = losses_of(service); !losses.empty())
      remarks += "  " + name_of(service) + " counts " + losses + "\n";
  }
  return table_text({"service", "state", "process", "up", "stage", "calls", "p50 ms", "p99 ms",
                     "worst ms"},
                    rows, 5) +
         remarks;
}

std::string topics_text(const std::vector<TopicLine>& topics) {
  std::vector<std::vector<std::string>> rows;
  for (const TopicLine& line : topics) {
    const TopicFigures& figures = line.figures;
    const bool is_silent = figures.samples == 0;
    const auto shown = [&](double number, int decimals) {
      return is_silent ? std::string("-") : files::fixed_text(number, decimals);
    };
    rows.push_back({line.topic, files::fixed_text(figures.rate_hz, 1),
                    shown(figures.mean_bytes / 1000.0, 2),
                    line.age_s < 0.0 ? "-" : files::fixed_text(line.age_s, 2),
                    std::to_string(line.lost), shown(figures.delay_p50_ms, 2),
                    shown(figures.delay_p99_ms, 2), shown(figures.longest_delay_ms, 2),
                    std::to_string(line.writers), std::to_string(line.readers)});
  }
  return table_text(
      {"topic", "Hz", "kB", "age s", "lost", "p50 ms", "p99 ms", "worst ms", "writers", "readers"},
      rows, 1);
}

}  // namespace slammot::inspector
