#include "services/ingest/ingest_service.hpp"

#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/dds.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/services/ingest/small_log.hpp"

namespace slammot::ingest {
namespace {

using namespace std::chrono_literals;
using slammot::testing::assign;
using slammot::testing::kForever;

constexpr int kScans = 20;

/// Stands in for localization, detection and tracking: sends their heartbeats and answers scans
/// with labels.
class Neighbours {
 public:
  explicit Neighbours(dds::Participant participant) : participant_(std::move(participant)) {
    wait_set_.on_data(scans_, [this] {
      scans_.take_each([this](const slammot_LaserScan& scan) { on_scan(scan); });
    });
  }

  std::function<void(const slammot_LaserScan&)> on_scan;
  int starting_beats = 0;  ///< Number of heartbeats in state starting.
  bool is_starting() const { return beats_ <= starting_beats; }

  void answer(std::int64_t stamp_ns) {
    slammot_ScanLabels labels{};
    assign(labels.vehicle_id, "car");
    assign(labels.scanner_id, "front");
    labels.stamp_ns = stamp_ns;
    labels_.write(labels);
  }

  void run_while(const std::atomic<bool>& goes_on) {
    while (goes_on) {
      beat();
      wait_set_.wait(20ms);
    }
  }

 private:
  void beat() {
    for (const char* service : {"localization", "detection", "tracking"}) {
      slammot_Heartbeat beat{};
      assign(beat.vehicle_id, "car");
      assign(beat.service_name, service);
      beat.state =
          beats_ < starting_beats ? slammot_SERVICE_STATE_STARTING : slammot_SERVICE_STATE_RUNNING;
      heartbeats_.write(beat);
    }
    ++beats_;
  }

  int beats_ = 0;
  dds::Participant participant_;
  dds::WaitSet wait_set_{participant_};
  dds::Reader<slammot_LaserScan> scans_{participant_, dds::topics::kLaserScan};
  dds::Writer<slammot_ScanLabels> labels_{participant_, dds::topics::kScanLabels};
  dds::Writer<slammot_Heartbeat> heartbeats_{participant_, dds::topics::kHeartbeat};
};

struct IngestOnTheBus : ::testing::Test {
  slammot::testing::TemporaryFolder folder;
  slammot::testing::PrivateBus bus;
  Neighbours neighbours{bus.join()};
  app::ServiceContext context{"ingest", options()};
  std::vector<std::uint32_t> arrived;

  app::ServiceOptions options() const {
    app::ServiceOptions options;
    options.vehicle_id = "car";
    options.domain_id = bus.domain_id;
    options.dds_config = bus.config;
    options.state_dir = folder.path();
    return options;
  }

  /// Plays the small log to its end.
  void play(const std::string& speed, double resend_after_s = 0.2,
            double wait_for_services_s = 20.0) {
    write_small_log(folder / "drive.log", kScans);
    IngestService::Settings settings;
    settings.input = folder / "drive.log";
    settings.speed = speed;
    settings.config.resend_after_s = resend_after_s;
    settings.config.wait_for_services_s = wait_for_services_s;
    const IngestService service(context, settings);
    std::atomic<bool> goes_on = true;
    std::thread others([&] { neighbours.run_while(goes_on); });
    context.after(kForever, [this] { context.stop(99); });
    context.run();
    goes_on = false;
    others.join();
    EXPECT_EQ(context.exit_code(), 0);
  }

  std::uint64_t count(const std::string& name) { return context.status().counter(name); }
};

TEST_F(IngestOnTheBus, SendsEveryScanInOrderAfterTheAnswerToThePreviousOne) {
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    arrived.push_back(scan.sequence_number);
    neighbours.answer(scan.stamp_ns);
  };
  play("max", 10.0);
  ASSERT_EQ(arrived.size(), kScans);
  for (std::uint32_t i = 0; i < kScans; ++i) EXPECT_EQ(arrived[i], i);
  EXPECT_EQ(count("scans"), kScans);
  EXPECT_EQ(count("log_finished"), 1U);
}

TEST_F(IngestOnTheBus, SendsUnansweredScansAgain) {
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    arrived.push_back(scan.sequence_number);
    const bool is_first_time = std::ranges::count(arrived, scan.sequence_number) == 1;
    if (scan.sequence_number == 7 && is_first_time) return;  // as if a service had died with it
    neighbours.answer(scan.stamp_ns);
  };
  play("max");
  EXPECT_EQ(std::ranges::count(arrived, 7U), 2);
  EXPECT_EQ(arrived.back(), kScans - 1U);
  EXPECT_EQ(count("given_up_scans"), 0U);
}

TEST_F(IngestOnTheBus, GivesUpAScanThatIsNeverAnswered) {
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    if (scan.sequence_number != 7) neighbours.answer(scan.stamp_ns);
  };
  play("max", 0.05);
  EXPECT_EQ(count("given_up_scans"), 1U);
  EXPECT_EQ(count("scans"), kScans);
}

TEST_F(IngestOnTheBus, SkipsScansThatThePreviousProcessSent) {
  static constexpr std::int64_t kDoneNs = 101'000'000'000;  // scans 0 to 10
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    arrived.push_back(scan.sequence_number);
    neighbours.answer(std::max(scan.stamp_ns, kDoneNs));
  };
  play("max", 10.0);
  EXPECT_THAT(arrived, ::testing::ElementsAre(0, 11, 12, 13, 14, 15, 16, 17, 18, 19));
  EXPECT_EQ(count("skipped_scans"), 10U);
}

TEST_F(IngestOnTheBus, PlaysAtItsSpeedWithoutWaitingForAnswers) {
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    arrived.push_back(scan.sequence_number);
  };
  play("20");
  EXPECT_EQ(arrived.size(), kScans);
}

TEST_F(IngestOnTheBus, WaitsForAServiceInStateStarting) {
  neighbours.starting_beats = 50;  // more than a second
  neighbours.on_scan = [this](const slammot_LaserScan& scan) {
    EXPECT_FALSE(neighbours.is_starting());
    arrived.push_back(scan.sequence_number);
    neighbours.answer(scan.stamp_ns);
  };
  play("max", 10.0, 0.5);
  EXPECT_EQ(arrived.size(), kScans);
  EXPECT_EQ(count("begun_without_all_services"), 0U);
}

}  // namespace
}  // namespace slammot::ingest
