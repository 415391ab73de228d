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

PolarView view_of(const Street& street) {
  return PolarView(detection::detect(street.scan(0, 0), {}));
}

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

constexpr std::int64_t kHalfSecondNs = 500'000'000;

/// A history with one scan every half second.
ScanHistory history_of(const std::vector<Street>& streets, bool is_confirmed = false) {
  ScanHistory history;
  std::int64_t stamp_ns = 0;
  for (const Street& street : streets)
    history.add(stamp_ns += kHalfSecondNs, view_of(street), earlier(street, is_confirmed).owners);
  return history;
}

/// Of the beam that points straight ahead, against the latest scan at least age_s old.
Past past_ahead(const Street& now, const ScanHistory& history, std::size_t scans,
                double age_s = 0.0) {
  return history.past_of(
      180, view_of(now),
      *history.older_than(static_cast<std::int64_t>(scans) * kHalfSecondNs, age_s), true);
}

Past past_ahead(const Street& now, const Street& then, bool is_confirmed = false) {
  return past_ahead(now, history_of({then}, is_confirmed), 1);
}

/// In the open: beams that meet nothing come back from nothing; one thing far aside.
Street in_the_open(std::vector<StreetBox> things) {
  Street street;
  street.known = {{{0.0, -40.0, 0.0}, 1.0, 1.0}};
  street.unknown = std::move(things);
  return street;
}

StreetBox leg_at(double x_m, double y_m) { return {{x_m, y_m, 0.0}, 0.3, 0.3}; }

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
  street.known = {{{20.0, 2.05, 0.0}, 60.0, 0.1}};  // along the way, 2 m to the left: echoes metres
                                                    // apart
  EXPECT_EQ(view_of(street).sight_of({12.3, 2.0}).sight, Sight::kThere);
}

TEST(SightOfPlace, IsEmptyWhereSomethingSoNearWouldHaveBeenEchoed) {
  EXPECT_EQ(view_of(in_the_open({})).sight_of({4.0, 0.0}).sight, Sight::kEmpty);
}

TEST(Past, OfWhatHasNotMovedIsThatItStood) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), with_box_at(15.0, 0.0)), Past::kStood);
}

TEST(Past, OfWhatCameToAPlaceThatWasFreeIsThatItArrived) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), with_box_at(18.0, 0.0)), Past::kArrived);
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), with_box_at(15.0, 6.0)), Past::kArrived);
}

TEST(Past, OfWhatDrovePastWhereItWasIsThatItReceded) {
  EXPECT_EQ(past_ahead(with_box_at(18.0, 0.0), with_box_at(15.0, 0.0)), Past::kReceded);
}

TEST(Past, OfWhatAMoverUncoversIsNotKnown) {
  EXPECT_EQ(past_ahead(with_box_at(18.0, 0.0), with_box_at(15.0, 0.0), true), Past::kUnknown);
}

TEST(Past, OfAPlaceThatAMoverHasJustLeftIsNotThatSomethingStoodThere) {
  EXPECT_EQ(past_ahead(with_box_at(15.0, 0.0), with_box_at(15.0, 0.0), true), Past::kUnknown);
}

TEST(Past, OfALegWhereNothingWasNearIsThatItAppeared) {
  EXPECT_EQ(past_ahead(in_the_open({leg_at(4.0, 0.0)}), in_the_open({leg_at(5.0, 2.0)})),
            Past::kAppeared);
}

TEST(Past, OfWhatAnswersNowAndThenIsNotThatItAppeared) {
  const ScanHistory history = history_of({in_the_open({leg_at(4.0, 0.0)}), in_the_open({})});
  EXPECT_EQ(past_ahead(in_the_open({leg_at(4.0, 0.0)}), history, 2), Past::kUnknown);
}

TEST(Past, OfWhatAMoverLeftIsNoReasonAgainstItsHavingAppeared) {
  const Street before = in_the_open({leg_at(4.0, 0.0)});
  ScanHistory history = history_of({before}, true);
  const Street empty = in_the_open({});
  history.add(2 * kHalfSecondNs, view_of(empty), earlier(empty).owners);
  EXPECT_EQ(past_ahead(before, history, 2), Past::kAppeared);
}

TEST(Past, OfAGlintThatGoesAlongWithTheScannerIsNotThatItAppeared) {
  const auto view_after = [](double x_m) {
    return PolarView(
        detection::detect(in_the_open({leg_at(x_m + 3.0, 3.0)}).scan(0, 0, {x_m, 0.0, 0.0}), {}));
  };
  ScanHistory history;
  for (const int step : {1, 2})
    history.add(step * kHalfSecondNs, view_after(step),
                std::vector<Owner>(view_after(step).beam_count()));
  EXPECT_EQ(
      history.past_of(270, view_after(3.0), *history.older_than(2 * kHalfSecondNs, 0.0), true),
      Past::kUnknown);
}

TEST(Past, OfALegWhereTheScannerSawAPillarLongAgoAndNothingSinceIsThatItAppeared) {
  const auto view_at = [](double x_m, std::vector<StreetBox> things) {
    return PolarView(
        detection::detect(in_the_open(std::move(things)).scan(0, 0, {x_m, 0.0, 0.0}), {}));
  };
  ScanHistory history;  // a pillar, then 1.5 s without anything
  history.add(kHalfSecondNs, view_at(1.0, {leg_at(4.0, 3.0)}), std::vector<Owner>(361));
  for (const int step : {2, 3, 4})
    history.add(step * kHalfSecondNs, view_at(step, {}), std::vector<Owner>(361));
  EXPECT_EQ(history.past_of(270, view_at(5.0, {leg_at(8.0, 3.0)}),
                            *history.older_than(4 * kHalfSecondNs, 0.5), true),
            Past::kAppeared);
}

TEST(ScanHistory, KnowsOfWhatHasProvenToMoveThatItDidBefore) {
  const Street street = with_box_at(15.0, 0.0);
  ScanHistory history;
  history.add(kHalfSecondNs, view_of(street), std::vector<Owner>(361, Owner{{7}, true, false}));
  EXPECT_EQ(past_ahead(street, history, 1), Past::kStood);
  history.confirm({8});
  EXPECT_EQ(past_ahead(street, history, 1), Past::kStood);
  history.confirm({7});
  EXPECT_EQ(past_ahead(street, history, 1), Past::kUnknown);
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
