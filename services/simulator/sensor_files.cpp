#include "services/simulator/sensor_files.hpp"

#include "services/simulator/drive_text.hpp"

namespace slammot::simulator {

SensorFiles::SensorFiles(const std::filesystem::path& prefix,
                         const simulation::ScenarioConfig& scenario)
    : scenario_(scenario) {
  const auto open = [&](const std::string& ending, const std::string& header) {
    paths_.push_back(std::filesystem::path(prefix) += ending);
    files_.emplace_back(paths_.back(), std::ios::binary | std::ios::trunc) << header;
    return files_.size() - 1;
  };
  open(".log", log_header(scenario));
  for (std::size_t i = 1; i <= scenario.more_scanners.size(); ++i)
    open("." + scenario.scanner_at(i).scanner_id + ".log", header_of_log_of(scenario, i));
  if (scenario.gnss.rate_hz > 0.0) gnss_ = open(".gnss.csv", gnss_header());
  if (scenario.compass.rate_hz > 0.0) compass_ = open(".compass.csv", compass_header());
}

void SensorFiles::add(const simulation::SimulatedScan& drive) {
  files_.front() << log_line(drive, scenario_);
  if (drive.scanner > 0) files_[drive.scanner] << line_of_log_of_its_scanner(drive, scenario_);
  for (const sensing::GnssFix& fix : drive.gnss) files_[*gnss_] << gnss_line(fix);
  for (const sensing::CompassReading& reading : drive.compass)
    files_[*compass_] << compass_line(reading);
}

std::optional<std::string> SensorFiles::close() {
  for (std::size_t i = 0; i < files_.size(); ++i) {
    files_[i].close();
    if (!files_[i]) return "cannot write all of " + paths_[i].string();
  }
  return std::nullopt;
}

}  // namespace slammot::simulator
