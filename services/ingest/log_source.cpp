#include "services/ingest/log_source.hpp"

#include "common/files/log_profile.hpp"

namespace slammot::ingest {

files::CarmenLogOptions log_options(const IngestConfig& config) {
  files::CarmenLogOptions options;
  options.scanner_id = config.scanner_id;
  options.uses_all_scanners = true;
  options.fallback_field_of_view_rad = config.fallback_field_of_view_rad;
  options.fallback_base_from_laser = {config.fallback_laser_ahead_m, config.fallback_laser_left_m,
                                      config.fallback_laser_heading_rad};
  return options;
}

files::Result<LogSource> LogSource::open(const std::filesystem::path& file,
                                         const IngestConfig& config,
                                         const files::TopicOptions& topics) {
  files::CarmenLogOptions options = log_options(config);
  options.topics = topics;
  auto log = files::CarmenLog::open(file, options);
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
    if (const auto* fix = std::get_if<sensing::GnssFix>(&*event)) {
      step.fixes.push_back(*fix);
      continue;
    }
    if (const auto* reading = std::get_if<sensing::CompassReading>(&*event)) {
      step.headings.push_back(*reading);
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
