#include "services/simulator/drive_files.hpp"

#include "common/simulation/drive.hpp"
#include "services/simulator/sensor_files.hpp"

namespace slammot::simulator {

DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder, const DriveFileNames& names,
                              HitsFile hits) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return {std::nullopt, "cannot make the folder " + folder.string() + ": " + error.message()};
  simulation::Drive drive(scenario);
  SensorFiles sensors(folder / names.log, scenario);
  TruthFiles truth(folder / names.truth, drive.stationary_in_world(), hits);
  while (const auto scan = drive.next()) {
    sensors.add(*scan);
    truth.add(*scan);
  }
  if (const auto fault = sensors.close()) return {std::nullopt, *fault};
  if (const auto fault = truth.close()) return {std::nullopt, *fault};
  const auto& paths = sensors.paths();
  return {DriveFiles{paths.front(),
                     {paths.begin() + 1, paths.end()},
                     truth.tum(),
                     truth.objects(),
                     truth.walls(),
                     drive.scan_count(),
                     truth.distance_m()},
          ""};
}

DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario,
                              const std::filesystem::path& folder, HitsFile hits) {
  return write_drive(scenario, folder, {scenario.name, scenario.name}, hits);
}

}  // namespace slammot::simulator
