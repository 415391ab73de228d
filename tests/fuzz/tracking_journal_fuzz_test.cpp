#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "services/tracking/tracking_journal.hpp"
#include "tests/fuzz/saved_state.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using slammot::testing::put_strange_number;
using slammot::testing::sealed_again;
using slammot::testing::Street;

flow::SegmentedScan scan(std::uint32_t sequence) {
  const double now_s = 0.03 * sequence;
  Street street;
  street.known = {{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}};
  street.unknown = {{{20.0, -15.0 + 8.0 * now_s, M_PI / 2.0}},
                    {{12.0 - now_s, 3.0, 0.0}, 0.4, 0.5}};
  return detection::detect(street.scan(static_cast<std::int64_t>(now_s * 1e9), sequence), {});
}

constexpr std::uint32_t kScans = 40;

std::vector<std::byte> example() {
  Tracker tracker({});
  Session session;
  for (std::uint32_t sequence = 0; sequence < kScans; ++sequence)
    session.last_results["front"] = tracker.step(scan(sequence));
  return to_bytes(session, tracker);
}

TEST(TrackingJournalFuzz, RefusesAnyBytes) {
  std::mt19937 random(1);
  Tracker tracker({});
  for (int i = 0; i < 2000; ++i) {
    std::vector<std::byte> bytes(random() % 3000);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    ASSERT_FALSE(restore(bytes, tracker));
    if (bytes.size() >= sizeof(std::uint64_t)) ASSERT_FALSE(restore(sealed_again(bytes), tracker));
  }
}

TEST(TrackingJournalFuzz, GoesOnWithWhateverItAccepts) {
  std::mt19937 random(3);
  const auto bytes = example();
  const flow::SegmentedScan next = scan(kScans), after = scan(kScans + 1);
  int accepted = 0;
  for (int i = 0; i < 1500; ++i) {
    auto strange = bytes;
    put_strange_number(strange, random() % (strange.size() - 8), random);
    Tracker tracker({});
    if (!restore(sealed_again(strange), tracker)) continue;
    ++accepted;
    tracker.step(next);
    EXPECT_EQ(tracker.step(after).labels.labels.size(), after.labels.size());
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace slammot::tracking
