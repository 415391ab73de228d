#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/files/carmen_log.hpp"
#include "common/sensing/scan.hpp"
#include "services/ingest/ingest_config.hpp"

namespace slammot::ingest {

/// Options for reading a log.
files::CarmenLogOptions log_options(const IngestConfig& config);

/// A scan and what was measured since the previous scan.
struct Step {
  std::vector<sensing::Odometry> odometry;
  std::vector<sensing::GnssFix> fixes;
  std::vector<sensing::CompassReading> headings;
  std::optional<sensing::LaserScan> scan;  ///< Empty after the last scan.
};

/// Reads a recorded drive scan by scan.
class LogSource {
 public:
  static files::Result<LogSource> open(const std::filesystem::path& file,
                                       const IngestConfig& config,
                                       const files::TopicOptions& topics = {});

  /// nullopt at the end of the log.
  std::optional<Step> next();

  const files::CarmenLog& log() const { return log_; }

 private:
  LogSource(files::CarmenLog log, double sweep_s) : log_(std::move(log)), sweep_s_(sweep_s) {}

  files::CarmenLog log_;
  double sweep_s_;
};

}  // namespace slammot::ingest
