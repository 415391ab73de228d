#include "services/simulator/drive_files.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "common/files/carmen_log.hpp"
#include "services/simulator/scenario_files.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::simulator {
namespace {

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

class WriteDrive : public ::testing::Test {
 protected:
  WriteDrive() {
    scenario_ = *load_scenario("block");
    scenario_.duration_s = 2.0;
  }
  slammot::testing::TemporaryFolder folder_;
  simulation::ScenarioConfig scenario_;
};

TEST_F(WriteDrive, WritesAScanAndATruePoseForEachPeriodOfTheScanner) {
  const auto files = write_drive(scenario_, folder_ / "new").files;
  ASSERT_TRUE(files.has_value());
  const auto log = lines_of(files->log);
  const auto tum = lines_of(files->tum);
  ASSERT_EQ(tum.size(), 75U);
  ASSERT_EQ(log.size(), 4U + 75U);
  EXPECT_EQ(log[1], "PARAM robot_frontlaser_offset 2.150");
}

TEST_F(WriteDrive, WritesScansInTheFormatOfCarmen) {
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  const auto words = words_of(lines_of(files->log)[4]);
  ASSERT_EQ(words.size(), 9U + 361U + 15U);
  EXPECT_EQ(words[0], "ROBOTLASER1");
  EXPECT_EQ(words[4], "0.008727");
  EXPECT_EQ(words[5], "81.83");
  EXPECT_EQ(words[8], "361");
  EXPECT_EQ(words[9 + 361], "0");             // remissions
  EXPECT_EQ(words[9 + 361 + 1], "2.150000");  // laser pose, then robot pose
  EXPECT_EQ(words[9 + 361 + 4], "0.000000");
  EXPECT_EQ(words[words.size() - 3], "21.000000");
}

TEST_F(WriteDrive, WritesIndoorScansAsFlaser) {
  scenario_ = *load_scenario("corridor");
  scenario_.duration_s = 2.0;
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  const auto words = words_of(lines_of(files->log)[4]);
  ASSERT_EQ(words.size(), 2U + 180U + 9U);
  EXPECT_EQ(words[0], "FLASER");
  EXPECT_EQ(words[1], "180");
  EXPECT_EQ(words[words.size() - 3], "1.000000");
}

TEST_F(WriteDrive, IsReproducible) {
  const auto first = write_drive(scenario_, folder_ / "a").files;
  const auto second = write_drive(scenario_, folder_ / "b").files;
  EXPECT_EQ(lines_of(first->log), lines_of(second->log));
  EXPECT_EQ(lines_of(first->objects), lines_of(second->objects));
  EXPECT_EQ(lines_of(first->walls), lines_of(second->walls));
}

TEST_F(WriteDrive, WritesTheHitsOfBeamsIfRequested) {
  const auto files = write_drive(scenario_, folder_.path(), HitsFile::written).files;
  ASSERT_TRUE(files.has_value());
  const auto hits = lines_of(folder_ / "block.hits.csv");
  ASSERT_EQ(hits.size(), 1U + 75U);
  EXPECT_EQ(hits[0], "timestamp,scanner,hits");
  EXPECT_EQ(hits[1].substr(0, 18), "21.000000,front,0*");
  write_drive(scenario_, folder_ / "without");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "without/block.hits.csv"));
}

simulation::ScannerConfig rear_scanner() {
  simulation::ScannerConfig rear;
  rear.scanner_id = "rear";
  rear.ahead_m = -2.2;
  rear.left_m = 0.3;
  rear.heading_rad = 3.141593;
  rear.rate_hz = 12.5;
  return rear;
}

TEST_F(WriteDrive, WritesALogForEachScannerThatIsReadWithItsMounting) {
  scenario_.more_scanners = {rear_scanner()};
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  EXPECT_EQ(files->more_sensors.at(0).filename(), "block.rear.log");
  const auto front_log = files::CarmenLog::open(files->log);
  const auto rear_log = files::CarmenLog::open(files->more_sensors.at(0));
  ASSERT_TRUE(front_log && rear_log);
  EXPECT_EQ(front_log->plan().figures.scans, 75U);
  EXPECT_EQ(rear_log->plan().figures.scans, 25U);
  EXPECT_EQ(rear_log->plan().base_from_laser, (geometry::Pose2{-2.2, 0.3, 3.141593}));
}

TEST_F(WriteDrive, WritesAllScannersIntoOneLog) {
  simulation::ScannerConfig rear = rear_scanner();
  rear.delay_s = 0.01;
  scenario_.more_scanners = {rear};
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  files::CarmenLogOptions options;
  options.uses_all_scanners = true;
  auto log = files::CarmenLog::open(files->log, options);
  ASSERT_TRUE(log.has_value());
  EXPECT_EQ(log->plan().scanners.at(1).base_from_laser, (geometry::Pose2{-2.2, 0.3, 3.141593}));
  std::map<std::string, int> scans;
  std::int64_t last_ns = 0;
  while (const auto event = log->next()) {
    const auto* scan = std::get_if<sensing::LaserScan>(&*event);
    if (scan == nullptr) continue;
    ++scans[scan->scanner.scanner_id];
    EXPECT_GT(scan->stamp_ns, last_ns);
    last_ns = scan->stamp_ns;
  }
  EXPECT_EQ(scans, (std::map<std::string, int>{{"ROBOTLASER1", 75}, {"ROBOTLASER2", 25}}));
  EXPECT_EQ(lines_of(files->tum).size(), 100U);
}

TEST_F(WriteDrive, WritesTheTruthOncePerStamp) {
  simulation::ScannerConfig rear;
  rear.scanner_id = "rear";
  rear.rate_hz = scenario_.scanner.rate_hz;
  scenario_.more_scanners = {rear};
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  EXPECT_EQ(lines_of(files->tum).size(), 75U);
}

TEST_F(WriteDrive, WritesHiddenObjectsForTenSeconds) {
  scenario_ = *load_scenario("occluded_car");
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  int hidden_rows = 0;
  double last_seen_s = 0.0;
  double longest_s = 0.0;
  for (const std::string& line : lines_of(files->objects)) {
    std::string text = line;
    std::ranges::replace(text, ',', ' ');
    const auto fields = words_of(text);
    if (fields[2] != "car") continue;
    const double at_s = std::stod(fields[0]);
    if (fields[9] != "0") last_seen_s = at_s;
    if (fields[9] == "0") ++hidden_rows;
    longest_s = std::max(longest_s, at_s - last_seen_s);
  }
  EXPECT_GT(hidden_rows, 2 * 37);  // behind the truck for three seconds
  EXPECT_LE(longest_s, 10.0);
}

TEST_F(WriteDrive, WritesGnssAndCompass) {
  scenario_.gnss.rate_hz = 5.0;
  scenario_.compass.rate_hz = 10.0;
  const auto files = write_drive(scenario_, folder_.path()).files;
  ASSERT_TRUE(files.has_value());
  EXPECT_EQ(lines_of(folder_ / "block.gnss.csv").size(), 1U + 10U);
  EXPECT_EQ(lines_of(folder_ / "block.compass.csv").size(), 1U + 20U);
}

TEST_F(WriteDrive, WritesTheTurnRatesOfAnImuIntoTheLog) {
  const auto without = write_drive(scenario_, folder_.path()).files;
  const std::size_t lines = lines_of(folder_ / "block.log").size();
  scenario_.imu.rate_hz = 100.0;
  ASSERT_TRUE(write_drive(scenario_, folder_.path()).files.has_value());
  const auto with_imu = lines_of(folder_ / "block.log");
  const auto imu = std::ranges::count_if(
      with_imu, [](const std::string& line) { return line.starts_with("IMU "); });
  EXPECT_EQ(with_imu.size(), lines + static_cast<std::size_t>(imu));
  EXPECT_GT(imu, 150);
}

TEST_F(WriteDrive, ReportsWhyItCannotWrite) {
  std::ofstream(folder_ / "file") << "in the way";
  const auto result = write_drive(scenario_, folder_ / "file");
  EXPECT_FALSE(result.files.has_value());
  EXPECT_NE(result.fault.find("file"), std::string::npos);
}

}  // namespace
}  // namespace slammot::simulator
