#include "services/tracking/scan_history.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;
using testing::StreetBox;

const StreetBox kWall{{40.0, 0.0, M_PI / 2.0}, 80.0, 1.0};

PolarView view_of(const Street& street) { return PolarView(detection::detect(street.scan(0, 0), {})); }

Street with_box_at(double x_m, double y_m) {
  Street street;
  street.known = {kWall};
  street.unknown = {{{x_m, y_m, 0.0}, 2.0, 2.0}};
  return street;
}

EarlierScan earlier(const Street& street, bool is_confirmed = false) {
  const PolarView view = view_of(street);
  return {0, view, std::vector<Owner>(view.beam_count(), Owner{{7}, is_confirmed, is_confirmed})};
}

/// Of the beam that points straight ahead.
Past past_ahead(const Street& now, const EarlierScan& then) { return past_of(180, view_of(now), then); }

TEST(SightOfPlace, TellsWhatABeamMetWentThroughOrCouldNotReach) {
  const PolarView view = view_of(with_box_at(15.0, 0.0));
  EXPECT_EQ(view.sight_of({14.0, 0.0}).sight, Sight::kThere);
  EXPECT_EQ(view.sight_of({8.0, 0.0}).sight, Sight::kThrough);
  EXPECT_EQ(view.sight_of({25.0, 0.0}).sight, Sight::kHidden);
  EXPECT_EQ(view.sight_of({-5.0, 0.0}).sight, Sight::kNothing);  // behind the scanner
}

TEST(SightOfPlace, DoesNotTakeAMissingEchoForAFreeWay) {
  Street street;  // nothing anywhere
  street.known = {{{0.0, -40.0, 0.0}, 1.0, 1.0}};
  EXPECT_EQ(view_of(street).sight_of({20.0, 0.0}).sight, Sight::kNothing);
}

TEST(SightOfPlace, IsThereBetweenTheEchoesOfAnObliqueWall) {
  Street street;
  street.known = {{{20.0, 2.05, 0.0}, 60.0, 0.1}};  // along the way, 2 m to the left: echoes metres apart
  EXPECT_EQ(view_of(street).sight_of({12.3, 2.0}).sight, Sight::kThere);
}

TEST(Past, OfWhatHasNotMovedIsThatItStood) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), earlier(with_box_at(15.0, 0.0))), Past::kStood);
}

TEST(Past, OfWhatCameToAPlaceThatWasFreeIsThatItArrived) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), earlier(with_box_at(18.0, 0.0))), Past::kArrived);
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), earlier(with_box_at(15.0, 6.0))), Past::kArrived);
}

TEST(Past, OfWhatDrovePastWhereItWasIsThatItReceded) {
  EXPECT_EQ(past_ahead(with_box_at(18.0, 0.0), earlier(with_box_at(15.0, 0.0))), Past::kReceded);
}

TEST(Past, OfWhatAMoverUncoversIsNotKnown) {
  EXPECT_EQ(past_ahead(with_box_at(18.0, 0.0), earlier(with_box_at(15.0, 0.0), true)), Past::kUnknown);
}

TEST(Past, OfAPlaceThatAMoverHasJustLeftIsNotThatSomethingStoodThere) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), earlier(with_box_at(15.0, 0.0), true)), Past::kUnknown);
}

TEST(ScanHistory, GivesTheYoungestScanThatIsOldEnough) {
  ScanHistory history;
  const PolarView view = view_of(with_box_at(15.0, 0.0));
  for (std::int64_t i = 0; i < 10; ++i) history.add(i * 200'000'000, view, {});
  const EarlierScan* then = history.older_than(1'800'000'000, 0.5);
  ASSERT_NE(then, nullptr);
  EXPECT_EQ(then->stamp_ns, 1'200'000'000);
  EXPECT_EQ(history.older_than(1'800'000'000, 5.0), nullptr);
}

}  // namespace
}  // namespace slammot::tracking
