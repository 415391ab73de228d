#include "services/simulator/live_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "services/simulator/drive_text.hpp"

namespace slammot::simulator {
namespace {

constexpr std::size_t kMostAhead = 64;

/// As written to and read from the log, with so many decimal places.
double with_places(double value, int places) {
  const double scale = std::pow(10.0, places);
  return std::round(value * scale) / scale;
}

}  // namespace

LiveDrive::LiveDrive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& truth_prefix)
    : scenario_(scenario),
      drive_(scenario),
      truth_(truth_prefix, drive_.stationary_in_world(), HitsFile::written),
      log_(std::filesystem::path(truth_prefix) += ".log.gz"),
      scans_(drive_.scan_count()),
      thread_([this](const std::stop_token& stop) { simulate(stop); }) {}

void LiveDrive::simulate(const std::stop_token& stop) {
  const std::string header = log_header(scenario_);
  log_.write(header);
  for (std::size_t begin = 0; begin < header.size();) {
    const std::size_t end = header.find('\n', begin);
    put(header.substr(begin, end - begin), stop);
    begin = end + 1;
  }
  while (const auto scan = drive_.next()) {
    truth_.add(*scan);
    if (scan->scanner != 0) continue;
    std::string line = log_line(*scan, scenario_);
    log_.write(line);
    line.pop_back();
    if (!put(std::move(line), stop)) break;
  }
  truth_.close();
  log_.close();
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

/// False when nobody reads any more.
bool LiveDrive::put(std::string text, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait(lock, stop, [this] { return ahead_.size() < kMostAhead; })) return false;
  ahead_.push_back(std::move(text));
  changed_.notify_all();
  return true;
}

std::optional<std::string_view> LiveDrive::next() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return has_ended_ || !ahead_.empty(); });
  if (ahead_.empty()) return std::nullopt;
  line_ = std::move(ahead_.front());
  ahead_.pop_front();
  ++line_number_;
  changed_.notify_all();
  return line_;
}

double LiveDrive::fraction_read() const {
  return scans_ == 0 ? 1.0 : std::min(1.0, static_cast<double>(line_number_) / static_cast<double>(scans_));
}

files::LogPlan plan_of(const simulation::ScenarioConfig& scenario) {
  const simulation::ScannerConfig& scanner = scenario.scanner;
  files::LogPlan plan;
  plan.laser = scenario.log_record == simulation::LogRecord::flaser ? files::LaserRecordKind::kFlaser : files::LaserRecordKind::kRobotLaser1;
  plan.clock = files::LogClock::kIpc;
  plan.odometry = files::OdometrySource::kLaserRecords;
  plan.base_from_laser = {with_places(scanner.ahead_m, 3), with_places(scanner.left_m, 3), with_places(scanner.heading_rad, 6)};
  plan.max_range_m = static_cast<double>(static_cast<float>(scanner.max_range_m));
  plan.figures.scans = static_cast<std::uint64_t>(std::floor(scenario.duration_s * scanner.rate_hz));
  plan.figures.beams = static_cast<std::size_t>(scanner.beams);
  plan.figures.has_clock = true;
  plan.figures.field_of_view_rad = scanner.field_of_view_rad;
  plan.figures.max_range_m = plan.max_range_m;
  plan.figures.scan_period_s = 1.0 / scanner.rate_hz;
  plan.figures.duration_s = scenario.duration_s;
  return plan;
}

}  // namespace slammot::simulator
