#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "common/files/carmen_log.hpp"
#include "common/files/gz_writer.hpp"
#include "common/files/line_source.hpp"
#include "common/simulation/drive.hpp"
#include "services/simulator/truth_files.hpp"

namespace slammot::simulator {

/// A drive that is simulated while it is read: yields the lines that write_drive() writes into the
/// log. A separate thread works a few scans ahead of the reader and writes the ground truth and
/// PREFIX.log.gz. The lines do not depend on the reader's speed.
class LiveDrive : public files::LineSource {
 public:
  LiveDrive(const simulation::ScenarioConfig& scenario, const std::filesystem::path& truth_prefix);

  std::optional<std::string_view> next() override;
  std::uint64_t line_number() const override { return line_number_; }
  double fraction_read() const override;

 private:
  void simulate(const std::stop_token& stop);
  bool put_lines(const std::string& lines, const std::stop_token& stop);
  bool put(std::string text, const std::stop_token& stop);

  simulation::ScenarioConfig scenario_;
  simulation::Drive drive_;
  TruthFiles truth_;
  files::GzWriter log_;
  std::uint64_t scans_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<std::string> ahead_;  // guarded by mutex_
  bool has_ended_ = false;         // guarded by mutex_
  std::string line_;
  std::uint64_t line_number_ = 0;
  std::jthread thread_;  // Last member: uses all others.
};

/// The plan that a survey of the log would give, with the figures that are known before the drive.
/// `wanted`: as CarmenLogOptions::scanners; fails for unknown scanners.
files::Result<files::LogPlan> plan_of(const simulation::ScenarioConfig& scenario,
                                      const std::vector<std::string>& wanted = {});

/// Number of scans of all scanners.
std::uint64_t scan_count(const simulation::ScenarioConfig& scenario);

}  // namespace slammot::simulator
