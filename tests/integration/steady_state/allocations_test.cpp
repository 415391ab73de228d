// Once as much has been in view as ever will be, a scan goes through localization, detection,
// tracking and mapping without memory being asked for.
#include <cstddef>
#include <cstdlib>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "common/simulation/drive.hpp"
#include "services/detection/detector.hpp"
#include "services/localization/localizer.hpp"
#include "services/simulator/scenario_files.hpp"
#include "services/tracking/tracker.hpp"
#include "tests/support/localizer_drive.hpp"
#include "tests/support/street.hpp"

namespace {

std::size_t allocations = 0;  // of this process, which has one thread

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
// A sanitizer has variants of its own of these, which do not fit the deletes below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace slammot {
namespace {

/// How often memory is asked for while the work is done.
template <typename Work>
std::size_t allocations_of(const Work& work) {
  const std::size_t before = allocations;
  work();
  return allocations - before;
}

TEST(Allocations, AreCounted) {
  EXPECT_EQ(allocations_of([] { delete new int(1); }), 1U);
  EXPECT_EQ(allocations_of([] {}), 0U);
}

TEST(Allocations, AreNotMadeByLocalizationAndMapping) {
  constexpr std::uint32_t kScans = 200;
  constexpr std::uint32_t kUntilSteady = 160;  // a floor is looked for in the first 20 m
  testing::DriveSetup setup{.world = testing::street(120.0),
                            .world_from_base_at = testing::arc({2.0, -1.0, 0.02}, 8.0, 0.0)};
  setup.scan_period_s = 1.0 / 37.5;
  testing::SimulatedDrive drive(setup);
  localization::LocalizerConfig config;
  config.odometry.watches_factors = false;  // which compares scans, with memory, until it ends
  localization::Localizer localizer{config};
  flow::LocalizedScan done_with;
  std::size_t of_mapping = 0;
  for (std::uint32_t number = 0; number < kScans; ++number) {
    const sensing::Odometry odometry = drive.odometry(number);
    const sensing::LaserScan scan = drive.scan(number);
    std::optional<flow::LocalizedScan> localized;
    const std::size_t by_localization = allocations_of([&] {
      localizer.add_odometry(odometry);
      localized = localizer.localize(scan, std::move(done_with));
    });
    ASSERT_TRUE(localized);
    const flow::ScanLabels labels = testing::all_stationary(*localized);
    const std::size_t by_mapping = allocations_of([&] { localizer.integrate(labels); });
    if (number >= kUntilSteady) {
      EXPECT_EQ(by_localization, 0U) << "scan " << number;
      of_mapping += by_mapping;
    }
    done_with = *std::move(localized);
  }
  EXPECT_LE(of_mapping, 2U) << "but where new ground comes into view the map grows";
}

TEST(Allocations, AreNotMadeByDetectionAndTracking) {
  constexpr int kScans = 300;
  constexpr int kUntilSteady = 200;  // the history is of two seconds
  detection::Detector detector{{}};
  tracking::Tracker tracker{{}};
  flow::SegmentedScan segmented;
  std::size_t of_all = 0;
  for (int number = 0; number < kScans; ++number) {
    testing::Street street{{{{60.0, 0.0, 0.0}, 1.0, 120.0}}, {}, {}};
    for (int i = 0; i < 6; ++i)
      street.unknown.push_back({{10.0 + 5.0 * i + 0.05 * number, -20.0 + 7.0 * i, 0.0}, 4.5, 1.8});
    const flow::LocalizedScan scan =
        street.scan(number * 26'666'667LL, static_cast<std::uint32_t>(number));
    const std::size_t of_this = allocations_of([&] {
      segmented = detector.detect(scan, std::move(segmented));
      tracker.step(segmented);
    });
    if (number >= kUntilSteady) of_all += of_this;
  }
  EXPECT_LE(of_all, 5U) << "but where they are seen to be cut otherwise than ever before";
  EXPECT_GE(tracker.counters().tracks_confirmed, 4U) << "there was next to nothing to do";
}

/// Here tracks begin and end, and now and then more is in view than ever was.
TEST(Allocations, AreFewOnADriveThroughTraffic) {
  constexpr int kScansBefore = 30 * 75 / 2;
  constexpr int kScans = 400;
  simulation::Drive drive(*simulator::load_scenario("block"));
  localization::Localizer localizer{localization::LocalizerConfig{}};
  detection::Detector detector{{}};
  tracking::Tracker tracker{{}};
  flow::LocalizedScan localized_done_with;
  flow::SegmentedScan segmented;
  std::size_t of_all = 0;
  for (int number = 0; number < kScansBefore + kScans; ++number) {
    const std::optional<simulation::SimulatedScan> now = drive.next();
    ASSERT_TRUE(now);
    const std::size_t of_this = allocations_of([&] {
      localizer.add_odometry(now->odometry);
      std::optional<flow::LocalizedScan> localized =
          localizer.localize(now->scan, std::move(localized_done_with));
      segmented = detector.detect(*localized, std::move(segmented));
      const tracking::TrackingResult& tracked = tracker.step(segmented);
      localizer.expect(tracked.objects);
      localizer.integrate(tracked.labels);
      localized_done_with = *std::move(localized);
    });
    if (number >= kScansBefore) of_all += of_this;
  }
  RecordProperty("allocations_a_scan", std::to_string(static_cast<double>(of_all) / kScans));
  EXPECT_LT(static_cast<double>(of_all) / kScans, 5.0);  // 96 were made before anything was used
                                                         // again
}

}  // namespace
}  // namespace slammot
