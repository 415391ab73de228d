#include "services/simulator/live_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/app/give_way.hpp"
#include "services/simulator/drive_text.hpp"

namespace slammot::simulator {
namespace {

constexpr std::size_t kMaxAheadLines = 64;

/// Rounds as writing to and reading from a log does.
double rounded_to_decimals(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(value * scale) / scale;
}

std::uint64_t scans_of(const simulation::ScenarioConfig& scenario, std::size_t scanner) {
  constexpr double kRoundingScans = 1e-6;
  const double steps = std::floor(scenario.duration_s * scenario.scanner.rate_hz);
  if (scanner == 0) return static_cast<std::uint64_t>(steps);
  const simulation::ScannerConfig& further = scenario.scanner_at(scanner);
  const double scans = (steps / scenario.scanner.rate_hz - further.delay_s) * further.rate_hz;
  return static_cast<std::uint64_t>(std::max(0.0, std::ceil(scans - kRoundingScans)));
}

files::ScannerPlan scanner_plan(const simulation::ScenarioConfig& scenario, std::size_t index) {
  const simulation::ScannerConfig& scanner = scenario.scanner_at(index);
  const bool is_flaser =
      scenario.more_scanners.empty() && scenario.log_record == simulation::LogRecord::flaser;
  files::ScannerPlan plan;
  plan.kind = is_flaser ? files::LaserRecordKind::kFlaser : files::LaserRecordKind::kRobotLaser1;
  plan.name = is_flaser ? "FLASER" : "ROBOTLASER" + std::to_string(index + 1);
  plan.slot = static_cast<std::uint8_t>(index + 1);
  plan.base_from_laser = {rounded_to_decimals(scanner.ahead_m, 3),
                          rounded_to_decimals(scanner.left_m, 3),
                          rounded_to_decimals(scanner.heading_rad, 6)};
  plan.max_range_m = static_cast<double>(static_cast<float>(scanner.max_range_m));
  plan.scans = scans_of(scenario, index);
  if (simulation::scans_vertically(scanner))
    plan.profile_mounting =
        sensing::in_space(plan.base_from_laser, {rounded_to_decimals(scanner.height_m, 3),
                                                 rounded_to_decimals(scanner.left_up_rad, 6),
                                                 rounded_to_decimals(scanner.nose_down_rad, 6)});
  return plan;
}

/// Figures of a scanner that are known before the drive.
files::LogFigures figures_of(const simulation::ScenarioConfig& scenario, std::size_t index) {
  const simulation::ScannerConfig& scanner = scenario.scanner_at(index);
  files::LogFigures figures;
  figures.scans = scans_of(scenario, index);
  figures.beams = static_cast<std::size_t>(scanner.beams);
  figures.has_clock = true;
  figures.field_of_view_rad = scanner.field_of_view_rad;
  figures.max_range_m = static_cast<double>(static_cast<float>(scanner.max_range_m));
  figures.scan_period_s = 1.0 / scanner.rate_hz;
  figures.duration_s = scenario.duration_s;
  return figures;
}

}  // namespace

LiveDrive::LiveDrive(const simulation::ScenarioConfig& scenario,
                     const std::filesystem::path& truth_prefix)
    : scenario_(scenario),
      drive_(scenario),
      truth_(truth_prefix, drive_.stationary_in_world(), HitsFile::written),
      log_(std::filesystem::path(truth_prefix) += ".log.gz"),
      scans_(scan_count(scenario)),
      thread_([this](const std::stop_token& stop) { simulate(stop); }) {}

void LiveDrive::simulate(const std::stop_token& stop) {
  app::give_way();  // to the services, which it is ahead of
  put_lines(log_header(scenario_), stop);
  while (const auto scan = drive_.next()) {
    truth_.add(*scan);
    if (!put_lines(log_line(*scan, scenario_), stop)) break;
  }
  truth_.close();
  log_.close();
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

bool LiveDrive::put_lines(const std::string& lines, const std::stop_token& stop) {
  log_.write(lines);
  for (std::size_t begin = 0; begin < lines.size();) {
    const std::size_t end = lines.find('\n', begin);
    if (!put(lines.substr(begin, end - begin), stop)) return false;
    begin = end + 1;
  }
  return true;
}

/// False if the reader has stopped.
bool LiveDrive::put(std::string text, const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait(lock, stop, [this] { return ahead_.size() < kMaxAheadLines; })) return false;
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
  return scans_ == 0
             ? 1.0
             : std::min(1.0, static_cast<double>(line_number_) / static_cast<double>(scans_));
}

std::uint64_t scan_count(const simulation::ScenarioConfig& scenario) {
  std::uint64_t scans = 0;
  for (std::size_t i = 0; i <= scenario.more_scanners.size(); ++i) scans += scans_of(scenario, i);
  return scans;
}

files::Result<files::LogPlan> plan_of(const simulation::ScenarioConfig& scenario,
                                      const std::vector<std::string>& wanted) {
  files::LogPlan plan;
  plan.clock = files::LogClock::kIpc;
  plan.odometry = files::OdometrySource::kLaserRecords;
  for (std::size_t i = 0; i <= scenario.more_scanners.size(); ++i) {
    files::ScannerPlan scanner = scanner_plan(scenario, i);
    (scanner.profile_mounting ? plan.profile_scanners : plan.scanners)
        .push_back(std::move(scanner));
  }
  if (plan.scanners.empty()) return files::Error{"no scanner of the scenario scans the plane"};
  if (auto fault = files::select_scanners(wanted, plan.scanners)) return *fault;
  plan.laser = plan.scanners.front().kind;
  plan.base_from_laser = plan.scanners.front().base_from_laser;
  plan.max_range_m = plan.scanners.front().max_range_m;
  plan.figures = figures_of(scenario, plan.scanners.front().slot - 1U);
  return plan;
}

}  // namespace slammot::simulator
