/// slammot-simulator as a process of its own: what it says on the bus is what slammot simulate
/// writes into files.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/dds/reader.hpp"
#include "common/dds/wait_set.hpp"
#include "common/files/carmen_log.hpp"
#include "common/wire/sensor.hpp"
#include "common/wire/truth.hpp"
#include "services/simulator/drive_files.hpp"
#include "services/simulator/drive_text.hpp"
#include "services/simulator/scenario_files.hpp"
#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::simulator {
namespace {

using namespace std::chrono_literals;

constexpr const char* kScenario = R"(
place: SCRIPT
duration_s: 4
script {
  vehicle { way [{ x_m: 0 }, { x_m: 200 }] speed { mps: 8 } }
  objects { kind: CAR way [{ x_m: 25 }, { x_m: 300 }] speed { mps: 7 } }
  objects { kind: PEDESTRIAN way [{ x_m: -12 y_m: 4 }, { x_m: 60 y_m: 4 }] speed { mps: 1.2 } copies: 3 ahead_variation_m: 9 }
  objects { kind: BUS way [{ x_m: 30 y_m: 40 }, { x_m: 90 y_m: 40 }] speed { mps: 5 } }
  fronts { along [{ x_m: -80 y_m: 12 }, { x_m: 220 y_m: 12 }] }
}
more_scanners { scanner_id: "rear" ahead_m: -2.2 heading_rad: 3.1416 rate_hz: 12.5 delay_s: 0.01 }
gnss { rate_hz: 5 }
compass { rate_hz: 10 }
)";

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// Without the header.
std::vector<std::string> rows_of(const std::filesystem::path& file) {
  std::vector<std::string> rows = lines_of(file);
  rows.erase(rows.begin());
  return rows;
}

std::string text_of(const std::filesystem::path& file) {
  std::string text;
  for (const std::string& line : lines_of(file)) text += line + '\n';
  return text;
}

std::vector<sensing::LaserScan> scans_of(const std::filesystem::path& log) {
  auto opened = files::CarmenLog::open(log);
  std::vector<sensing::LaserScan> scans;
  while (auto event = opened->next()) {
    if (auto* scan = std::get_if<sensing::LaserScan>(&*event)) scans.push_back(std::move(*scan));
  }
  return scans;
}

/// Without its line end.
std::string trimmed(std::string line) {
  line.pop_back();
  return line;
}

class Simulator : public ::testing::Test {
 protected:
  Simulator() { std::ofstream(folder_ / "mine.textproto") << kScenario; }

  template <typename Sample, typename Take>
  void read(const dds::Topic<Sample>& topic, Take take) {
    const auto reader =
        std::make_shared<dds::Reader<Sample>>(participant_, topic, dds::History::kRecorder);
    wait_set_.on_data(*reader, [reader, take] { reader->take_each(take); });
    readers_.push_back(reader);
  }

  void listen() {
    read(dds::topics::kLaserScan, [this](const auto& sample) {
      const auto scan = wire::decode(sample);
      ASSERT_TRUE(scan) << scan.fault();
      drive_ids_.insert(sample.drive_id);
      scans_[scan->scanner.scanner_id].push_back(*scan);
    });
    read(dds::topics::kOdometry,
         [this](const auto& sample) { odometry_[sample.stamp_ns] = *wire::decode(sample); });
    read(dds::topics::kGnssFix, [this](const auto& sample) {
      gnss_.push_back(trimmed(gnss_line(*wire::decode(sample))));
    });
    read(dds::topics::kCompassReading, [this](const auto& sample) {
      compass_.push_back(trimmed(compass_line(*wire::decode(sample))));
    });
    read(dds::topics::kTruePose, [this](const auto& sample) {
      const auto pose = wire::decode(sample);
      simulation::SimulatedScan scan;
      scan.scan.stamp_ns = pose->stamp_ns;
      scan.world_from_base = pose->world_from_base;
      tum_.push_back(trimmed(tum_line(scan)));
      drive_ids_.insert(sample.drive_id);
    });
    read(dds::topics::kTrueObjects, [this](const auto& sample) {
      const auto truth = wire::decode(sample);
      ASSERT_TRUE(truth) << truth.fault();
      objects_a_scan_.insert(truth->objects.size());
      if (truth->scanner_id != "front") return;
      simulation::SimulatedScan scan;
      scan.scan.stamp_ns = truth->stamp_ns;
      for (const auto& object : truth->objects) {
        if (object.points > 0) scan.objects.push_back(object);
      }
      if (!scan.objects.empty()) objects_ += object_lines(scan);
    });
    read(dds::topics::kTrueHits, [this](const auto& sample) {
      const auto truth = wire::decode(sample);
      simulation::SimulatedScan scan;
      scan.scan.stamp_ns = truth->stamp_ns;
      scan.scan.scanner.scanner_id = truth->scanner_id;
      scan.hits = truth->hits;
      hits_[truth->scanner_id].push_back(trimmed(hits_line(scan)));
    });
  }

  /// Runs the process to its end; its exit code.
  int run(const std::vector<std::string>& arguments) {
    std::vector<std::string> all = {SLAMMOT_SIMULATOR, "--domain", std::to_string(bus_.domain_id),
                                    "--state-dir", folder_ / "state"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& argument : all) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    const pid_t process = fork();
    if (process == 0) {
      setenv("CYCLONEDDS_URI", bus_.config.c_str(), 1);
      execv(pointers[0], pointers.data());
      _exit(127);
    }
    int status = 0;
    const auto end = std::chrono::steady_clock::now() + 3 * slammot::testing::kForever;
    while (waitpid(process, &status, WNOHANG) == 0) {
      wait_set_.wait(20ms);
      if (std::chrono::steady_clock::now() > end) kill(process, SIGKILL);
    }
    for (int i = 0; i < 10; ++i) wait_set_.wait(20ms);  // what is still on its way
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  slammot::testing::TemporaryFolder folder_;
  slammot::testing::PrivateBus bus_;
  dds::Participant participant_ = bus_.join();
  dds::WaitSet wait_set_{participant_};
  std::vector<std::shared_ptr<void>> readers_;
  std::map<std::string, std::vector<sensing::LaserScan>> scans_;
  std::map<std::int64_t, sensing::Odometry> odometry_;
  std::set<std::uint64_t> drive_ids_;
  std::vector<std::string> gnss_, compass_, tum_;
  std::set<std::size_t> objects_a_scan_;
  std::string objects_ = objects_header();
  std::map<std::string, std::vector<std::string>> hits_;
};

TEST_F(Simulator, SaysOnTheBusWhatIsInTheFiles) {
  listen();
  ASSERT_EQ(run({"--scenario", folder_ / "mine.textproto", "--seed", "7", "--speed", "2",
                 "--wait-for-services", "1"}),
            0);
  const auto files = write_drive(*load_scenario(folder_ / "mine.textproto", 7), folder_ / "files",
                                 HitsFile::written)
                         .files;
  ASSERT_TRUE(files);

  EXPECT_EQ(drive_ids_.size(), 1U);
  const std::map<std::string, std::filesystem::path> logs = {{"front", files->log},
                                                             {"rear", files->more_sensors.at(0)}};
  for (const auto& [scanner_id, log] : logs) {
    const auto expected = scans_of(log);
    const auto& received = scans_[scanner_id];
    ASSERT_EQ(received.size(), expected.size()) << scanner_id;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(received[i].sequence, i);
      EXPECT_NEAR(static_cast<double>(received[i].stamp_ns - expected[i].stamp_ns), 0.0,
                  1000.0);  // the log has microseconds
      EXPECT_EQ(received[i].range_m, expected[i].range_m);
      EXPECT_NEAR(received[i].scanner.base_from_laser.x_m, expected[i].scanner.base_from_laser.x_m,
                  1e-3);
      EXPECT_NEAR(received[i].scanner.beam_step_rad, expected[i].scanner.beam_step_rad, 1e-6);
      EXPECT_TRUE(odometry_.contains(received[i].stamp_ns));
    }
  }
  EXPECT_EQ(gnss_, rows_of(folder_ / "files/mine.gnss.csv"));
  EXPECT_EQ(compass_, rows_of(folder_ / "files/mine.compass.csv"));
  // On the bus the truth is of the first scanner's scans; the files have it for each stamp, and
  // count the beams of all scanners.
  const std::vector<std::string> true_poses = lines_of(files->tum);
  EXPECT_EQ(true_poses.size(), 150U + 50U);
  EXPECT_EQ(tum_.size(), 150U);
  for (const std::string& pose : tum_)
    EXPECT_TRUE(std::ranges::count(true_poses, pose) == 1) << pose;
  const std::string true_objects = text_of(files->objects);
  EXPECT_GT(std::ranges::count(objects_, '\n'), 150);
  std::istringstream objects(objects_);
  for (std::string row; std::getline(objects, row);) {
    const std::size_t without_points = row.rfind(',', row.rfind(',') - 1);
    EXPECT_NE(true_objects.find(row.substr(0, without_points)), std::string::npos) << row;
  }
  EXPECT_EQ(objects_a_scan_, std::set<std::size_t>{5});  // the hidden and the far, too
  std::map<std::string, std::vector<std::string>> expected_hits;
  for (const std::string& row : rows_of(folder_ / "files/mine.hits.csv"))
    expected_hits[row.find(",rear,") == std::string::npos ? "front" : "rear"].push_back(row);
  EXPECT_EQ(hits_, expected_hits);
}

TEST_F(Simulator, RefusesWhatCannotBeDriven) {
  EXPECT_EQ(run({}), 2);
  EXPECT_EQ(run({"--scenario", "no_such_scenario"}), 2);
  EXPECT_EQ(run({"--scenario", folder_ / "mine.textproto", "--speed", "slow"}), 2);
}

}  // namespace
}  // namespace slammot::simulator
