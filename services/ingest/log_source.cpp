#include "services/ingest/log_source.hpp"

#include "common/files/log_profile.hpp"

namespace slammot::ingest {

files::CarmenLogOptions log_options(const IngestConfig& config) {
  return {config.scanner_id, config.fallback_field_of_view_rad,
          {config.fallback_laser_ahead_m, config.fallback_laser_left_m, config.fallback_laser_heading_rad}};
}

files::Result<LogSource> LogSource::open(const std::filesystem::path& file, const IngestConfig& config) {
  auto log = files::CarmenLog::open(file, log_options(config));
  if (!log) return log.error();
  const double sweep_s = files::sweep_s_for(log->plan().figures, config.sweep_s);
  return LogSource(std::move(*log), sweep_s);
}

std::optional<Step> LogSource::next() {
  Step step;
  while (auto event = log_.next()) {
    if (const auto* odometry = std::get_if<sensing::Odometry>(&*event)) {
      step.odometry.push_back(*odometry);
      continue;
    }
    step.scan = std::get<sensing::LaserScan>(std::move(*event));
    step.scan->scanner.sweep_s = sweep_s_;
    return step;
  }
  if (step.odometry.empty()) return std::nullopt;
  return step;
}

}  // namespace slammot::ingest
