#include "services/tracking/object_class.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace slammot::tracking {
namespace {

using flow::ClassProbabilities;
using flow::ObjectClass;

const TrackingConfig kStreet;

/// A box of which both sizes were seen from edge to edge, as well as sigma_m says.
Box box_of(double length_m, double width_m, double sigma_m = 0.1) {
  Box box;
  box.is_oriented = true;
  const auto surely = [&](double size_m) { return std::max(0.0, size_m - 2.0 * sigma_m); };
  box.evidence.length = {surely(length_m), {length_m, sigma_m * sigma_m}};
  box.evidence.width = {surely(width_m), {width_m, sigma_m * sigma_m}};
  return with_likely_sizes(box, kStreet);
}

Blob blob_of(double extent_m, bool was_seen_whole = true) {
  Blob blob;
  blob.was_seen_whole = was_seen_whole;
  blob.length = blob.width = {extent_m, 1.0};
  return blob;
}

SpeedsSeen held(double speed_mps, double seconds, SpeedsSeen speeds = {}) {
  constexpr double kScanS = 0.025;
  for (double t = 0.0; t < seconds; t += kScanS)
    speeds = with_speed(speeds, {speed_mps, 0.2, kScanS}, kStreet);
  return speeds;
}

double of(ObjectClass object_class, const ClassProbabilities& probability) {
  return probability[static_cast<std::size_t>(object_class) - 1];
}

TEST(ObjectClass, FollowsFromSizesThatAreWellSeen) {
  EXPECT_GT(of(ObjectClass::kCar, class_probabilities(box_of(4.4, 1.8), {}, kStreet)), 0.99);
  EXPECT_GT(of(ObjectClass::kTruckOrBus, class_probabilities(box_of(8.0, 2.4), {}, kStreet)), 0.99);
  EXPECT_GT(of(ObjectClass::kTruckOrBus, class_probabilities(box_of(12.0, 2.5), {}, kStreet)),
            0.99);
  EXPECT_GT(of(ObjectClass::kBicycle, class_probabilities(box_of(1.75, 0.65, 0.05), {}, kStreet)),
            0.7);
}

TEST(ObjectClass, IsAsOpenAsTheSizesAre) {
  const double sharply =
      of(ObjectClass::kTruckOrBus, class_probabilities(box_of(5.6, 2.2, 0.1), {}, kStreet));
  const double vaguely =
      of(ObjectClass::kTruckOrBus, class_probabilities(box_of(5.6, 2.2, 2.0), {}, kStreet));
  EXPECT_GT(sharply, 0.9);
  EXPECT_LT(vaguely, 0.5);
}

TEST(ObjectClass, HasProbabilitiesThatAddUp) {
  for (const Outline& body : {Outline(box_of(4.4, 1.8)), Outline(box_of(30.0, 0.1)),
                              Outline(blob_of(0.5)), Outline(blob_of(50.0))}) {
    for (const double speed_mps : {0.0, 1.4, 200.0}) {
      const ClassProbabilities probability =
          class_probabilities(body, held(speed_mps, 5.0), kStreet);
      EXPECT_NEAR(std::accumulate(probability.begin(), probability.end(), 0.0), 1.0, 1e-12);
    }
  }
}

TEST(ObjectClass, OfSomethingSmallIsToldBySpeedInTime) {
  const Blob small = blob_of(0.55);
  EXPECT_EQ(likeliest_class(class_probabilities(small, held(1.4, 2.0), kStreet)),
            ObjectClass::kPedestrian);
  EXPECT_EQ(likeliest_class(class_probabilities(small, held(4.5, 4.0), kStreet)),
            ObjectClass::kBicycle);
  const double soon =
      of(ObjectClass::kBicycle, class_probabilities(small, held(3.5, 0.3), kStreet));
  const double later =
      of(ObjectClass::kBicycle, class_probabilities(small, held(3.5, 3.0), kStreet));
  EXPECT_GT(later, soon);
}

TEST(ObjectClass, OfWhatHasAlwaysHadAnEndHiddenMayBeThatOfAVehiclesCorner) {
  const auto vehicle_share = [](bool was_seen_whole) {
    const ClassProbabilities probability =
        class_probabilities(blob_of(0.55, was_seen_whole), {}, kStreet);
    return of(ObjectClass::kCar, probability) + of(ObjectClass::kTruckOrBus, probability);
  };
  EXPECT_LT(vehicle_share(true), 0.03);
  EXPECT_GT(vehicle_share(false), 0.5);
}

TEST(ObjectClass, IsToldByTheFirstSpeedWhichIsNotYetHeld) {
  const SpeedsSeen fast = with_first_speed({9.0, 0.5, 0.0}, kStreet);
  EXPECT_EQ(likeliest_class(class_probabilities(blob_of(0.55, false), fast, kStreet)),
            ObjectClass::kCar);
  EXPECT_EQ(fast.surely_mps, 0.0);
  const double first =
      of(ObjectClass::kPedestrian,
         class_probabilities(blob_of(0.55), with_first_speed({3.5, 0.5, 0.0}, kStreet), kStreet));
  const double one_scan =
      of(ObjectClass::kPedestrian, class_probabilities(blob_of(0.55), held(3.5, 0.02), kStreet));
  EXPECT_LT(first, one_scan);
}

TEST(ObjectClass, DoesNotForgetThatItWasTooFastForLegs) {
  const SpeedsSeen rode = held(5.0, 4.0);
  const double after_riding = of(
      ObjectClass::kPedestrian, class_probabilities(blob_of(0.55), held(1.4, 20.0, rode), kStreet));
  const double never_rode =
      of(ObjectClass::kPedestrian, class_probabilities(blob_of(0.55), held(1.4, 20.0), kStreet));
  EXPECT_LT(after_riding, 0.5);
  EXPECT_GT(never_rode, 0.95);
}

TEST(ObjectClass, IsNotChangedByTheErrorOfAMoment) {
  const SpeedsSeen walked = held(1.4, 3.0);
  const SpeedsSeen jumped = held(9.0, 0.1, walked);
  EXPECT_EQ(likeliest_class(class_probabilities(blob_of(0.55), held(1.4, 1.0, jumped), kStreet)),
            ObjectClass::kPedestrian);
}

TEST(ObjectClass, OfACarThatCreepsStaysThatOfACar) {
  EXPECT_EQ(likeliest_class(class_probabilities(box_of(4.4, 1.8, 0.3), held(1.4, 60.0), kStreet)),
            ObjectClass::kCar);
}

TEST(ObjectClass, OfTwoWhoWalkSideBySideIsThatOfOne) {
  EXPECT_EQ(likeliest_class(class_probabilities(box_of(1.4, 0.5), held(1.3, 3.0), kStreet)),
            ObjectClass::kPedestrian);
  EXPECT_EQ(likeliest_class(class_probabilities(box_of(0.5, 1.4), held(1.3, 3.0), kStreet)),
            ObjectClass::kPedestrian);
}

TEST(ObjectClass, CountsSpeedsByTimeAndNotByScans) {
  SpeedsSeen often, seldom;
  for (int i = 0; i < 100; ++i) often = with_speed(often, {3.0, 0.3, 0.01}, kStreet);
  for (int i = 0; i < 10; ++i) seldom = with_speed(seldom, {3.0, 0.3, 0.1}, kStreet);
  for (std::size_t i = 0; i < often.log_likelihood.size(); ++i)
    EXPECT_NEAR(often.log_likelihood[i], seldom.log_likelihood[i],
                0.02 * std::abs(often.log_likelihood[i]));
  EXPECT_NEAR(often.surely_mps, seldom.surely_mps, 0.1);
}

TEST(ObjectClass, GoesWithTheScaleOfAModelTown) {
  TrackingConfig town;
  town.extent.size_scale = 0.1;
  Box model = box_of(0.44, 0.18, 0.01);
  EXPECT_EQ(
      likeliest_class(class_probabilities(model, with_speed({}, {0.8, 0.02, 1.0}, town), town)),
      ObjectClass::kCar);
}

TEST(ObjectClass, IsUnknownWhereNoClassOutweighsTheOthers) {
  EXPECT_EQ(likeliest_class({0.3, 0.4, 0.2, 0.1}), ObjectClass::kUnknown);
  EXPECT_EQ(likeliest_class({}), ObjectClass::kUnknown);
  EXPECT_EQ(likeliest_class({0.1, 0.1, 0.2, 0.6}), ObjectClass::kTruckOrBus);
}

}  // namespace
}  // namespace slammot::tracking
