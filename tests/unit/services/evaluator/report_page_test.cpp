#include "services/evaluator/report_page.hpp"

#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <CLI/CLI.hpp>

#include "services/evaluator/report_command.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/evaluator/files.hpp"

namespace slammot::evaluator {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

ResultTrack row(std::uint32_t id, const char* object_class, bool is_moving = true) {
  ResultTrack track;
  track.track_id = id;
  track.object_class = object_class;
  track.is_moving = is_moving;
  return track;
}

TEST(ChooseTracks, TakesTheLongestTwoOfEachClassAndThoseThatStopped) {
  RunResult result;
  for (std::int64_t stamp_ns = 0; stamp_ns < 10; ++stamp_ns) {
    TracksAt at{stamp_ns, {row(1, "car"), row(2, "pedestrian")}};
    if (stamp_ns < 8) at.tracks.push_back(row(3, "car"));
    if (stamp_ns < 5) at.tracks.push_back(row(4, "car", stamp_ns != 2));  // stops once
    if (stamp_ns < 3) at.tracks.push_back(row(5, "car"));
    result.tracks.push_back(at);
  }
  EXPECT_THAT(choose_tracks(result), ElementsAre(1, 3, 2, 4));
}

class ReportPage : public ::testing::Test {
 protected:
  ReportPage() {
    write(folder_ / "online.tum", straight_tum(0.0));
    write(folder_ / "trajectory.tum", straight_tum(0.0));
    write(folder_ / "tracks.csv", tracks_csv(0.0, 0.3));
    write(folder_ / "drive.tum", straight_tum(100.0));
    write(folder_ / "drive.objects.csv", car_ahead_csv(100.0));
  }

  std::string page(const std::string& more) {
    CLI::App app;
    int exit_code = 0;
    add_report_command(app, exit_code);
    ::testing::internal::CaptureStdout();
    app.parse("report --result " + folder_.path().string() + more);
    ::testing::internal::GetCapturedStdout();
    EXPECT_EQ(exit_code, 0);
    std::ifstream file(folder_ / "report.html");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ReportPage, NeedsNoTruth) {
  const std::string html = page("");
  EXPECT_THAT(html, HasSubstr("Track 7, car"));
  EXPECT_THAT(html, Not(HasSubstr("Against the truth")));
}

TEST_F(ReportPage, ShowsErrorsAndTrueSpeedsWhereThereIsTruth) {
  const std::string html = page(" --truth " + (folder_ / "drive").string());
  for (const char* part : {"Evaluation against ground truth", "position error [m]", "true speed",
                           "true class: car", "HOTA"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST_F(ReportPage, IsSelfContained) {
  const std::string html = page(" --truth " + (folder_ / "drive").string());
  for (const char* part : {"http:", "https:", "src=", "<link", "@import", "url("})
    EXPECT_THAT(html, Not(HasSubstr(part)));
}

TEST_F(ReportPage, ShowsTheRequestedTracks) {
  EXPECT_THAT(page(" --tracks 99"), Not(HasSubstr("Single tracks")));
}

}  // namespace
}  // namespace slammot::evaluator
