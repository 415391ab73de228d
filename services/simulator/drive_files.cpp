#include "services/simulator/drive_files.hpp"

#include <fstream>

#include "common/simulation/drive.hpp"
#include "services/simulator/drive_text.hpp"
#include "services/simulator/truth_files.hpp"

namespace slammot::simulator {

DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& folder, const DriveFileNames& names) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return {std::nullopt, "cannot make the folder " + folder.string() + ": " + error.message()};
  simulation::Drive drive(scenario);
  const std::filesystem::path log_path = folder / (names.log + ".log");
  std::ofstream log(log_path, std::ios::binary | std::ios::trunc);
  TruthFiles truth(folder / names.truth, drive.stationary_in_world());
  log << log_header(scenario);
  while (const auto scan = drive.next()) {
    log << log_line(*scan, scenario);
    truth.add(*scan);
  }
  log.close();
  if (!log) return {std::nullopt, "cannot write all of the drive into " + folder.string()};
  if (const auto fault = truth.close()) return {std::nullopt, *fault};
  return {DriveFiles{log_path, truth.tum(), truth.objects(), truth.walls(), drive.scan_count(), truth.distance_m()}, ""};
}

DriveFilesOrFault write_drive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& folder) {
  return write_drive(scenario, folder, {scenario.name, scenario.name});
}

}  // namespace slammot::simulator
