#include "services/tracking/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/example_tracks.hpp"
#include "tests/support/help_at_the_last_moment.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Pose2;
using geometry::Vector2;
using testing::among_people;
using testing::Street;
using testing::StreetBox;

constexpr double kPeriodS = 1.0 / 37.5;
const StreetBox kWall{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0};

/// A street that plays before a scanner at rest.
class Play {
 public:
  explicit Play(const TrackingConfig& config = {}, double period_s = kPeriodS,
                work::SideWork* help = nullptr)
      : period_s_(period_s), tracker_(config, help) {
    street.known = {kWall};
  }

  /// Lets time pass; `scene` sets the street for each moment.
  void run(double seconds, const std::function<void(Street&, double)>& scene) {
    for (int i = 0; i < std::lround(seconds / period_s_); ++i) step(scene);
  }

  void step(const std::function<void(Street&, double)>& scene) {
    scene(street, now_s());
    const auto stamp_ns = static_cast<std::int64_t>(now_s() * 1e9);
    result = tracker_.step(detection::detect(street.scan(stamp_ns, sequence_), {}));
    ++sequence_;
    for (const flow::TrackedObject& object : confirmed()) ids.insert(object.track_id.value);
  }

  double now_s() const { return sequence_ * period_s_; }
  Tracker& tracker() { return tracker_; }

  std::vector<flow::TrackedObject> confirmed() const { return published(false); }
  std::vector<flow::TrackedObject> occluded() const { return published(true); }

  Street street;
  TrackingResult result;
  std::set<std::uint32_t> ids;  ///< Of all that were ever confirmed and seen.

 private:
  std::vector<flow::TrackedObject> published(bool occluded) const {
    std::vector<flow::TrackedObject> objects;
    for (const flow::TrackedObject& object : result.objects.objects)
      if (object.confirmed && object.occluded == occluded) objects.push_back(object);
    return objects;
  }

  double period_s_;
  Tracker tracker_;
  std::uint32_t sequence_ = 0;
};

/// An open hall of which the map knows nothing, seen at the height of legs 7.5 times a second.
Play hall() {
  Play play(among_people(), 1.0 / 7.5);
  play.street.known = {{{0.0, -40.0, 0.0}, 1.0, 1.0}};
  play.street.knows_the_open = false;
  play.street.beams = 512;
  return play;
}

/// Two legs of somebody, one ahead of the other in turn.
std::vector<StreetBox> legs_at(double x_m, double y_m, double t) {
  const double swing_m = 0.2 * std::sin(2.0 * M_PI * t);
  return {{{x_m + swing_m, y_m + 0.1, 0.0}, 0.12, 0.12},
          {{x_m - swing_m, y_m - 0.1, 0.0}, 0.12, 0.12}};
}

TEST(Tracker, KnowsWhereACarThatCrossesIsAndHowFast) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{20.0, -15.0 + 8.0 * t, M_PI / 2.0}}};
  };
  play.run(2.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackedObject car = play.confirmed().front();
  const double t = play.now_s() - kPeriodS;
  EXPECT_LT((car.position_in_odom_m - Vector2(20.0, -15.0 + 8.0 * t)).norm(), 0.3);
  EXPECT_LT((car.velocity_in_odom_mps - Vector2(0.0, 8.0)).norm(), 0.3);
  EXPECT_EQ(car.object_class, flow::ObjectClass::kCar);
  EXPECT_NEAR(car.length_m, 4.5, 0.4);
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, DrawsAnewWhatIsAgainAndAgainTooFarFromWhereItMustBe) {
  Play play;
  constexpr double kBesideM = 0.75;  // as if another part of it had come into view
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{t < 2.0 ? 20.0 : 20.0 - kBesideM, -15.0 + 8.0 * t, M_PI / 2.0}}};
  };
  play.run(2.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  int unpublished = 0;
  for (int scan = 0; scan < 20; ++scan) {
    play.step(scene);
    unpublished += play.confirmed().empty() ? 1 : 0;
  }
  EXPECT_GE(unpublished, 1) << "once it may be somebody else";
  EXPECT_LE(unpublished, 5);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.ids.size(), 1U);
  EXPECT_LT((play.confirmed().front().position_in_odom_m -
             Vector2(20.0 - kBesideM, -15.0 + 8.0 * (play.now_s() - kPeriodS)))
                .norm(),
            0.3);
  EXPECT_LT((play.confirmed().front().velocity_in_odom_mps - Vector2(0.0, 8.0)).norm(), 0.5);
}

TEST(Tracker, FollowsACarAcrossTheSeamOfAFullTurn) {
  Play play;
  play.street.look_all_round();
  play.street.known.push_back({{-40.0, 0.0, M_PI / 2.0}, 120.0, 1.0});
  for (int i = 0; i < 100; ++i) {
    play.step([](Street& street, double t) {
      street.unknown = {{{-10.0, -9.0 + 6.0 * t, M_PI / 2.0}}};
    });
    if (play.now_s() < 1.0) continue;
    ASSERT_EQ(play.confirmed().size(), 1U) << play.now_s();
    const flow::TrackedObject car = play.confirmed().front();
    EXPECT_LT(
        (car.position_in_odom_m - Vector2(-10.0, -9.0 + 6.0 * (play.now_s() - kPeriodS))).norm(),
        0.3)
        << play.now_s();
    EXPECT_LT((car.velocity_in_odom_mps - Vector2(0.0, 6.0)).norm(), 0.45) << play.now_s();
  }
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, KnowsWhereACarIsAtTheStampThoughTheBeamThatMeetsItIsFiredLater) {
  constexpr double kSlowPeriodS = 0.1;
  for (const double sweep_s : {0.099, -0.099}) {  // negative: one that turns the other way round
    Play play({}, kSlowPeriodS);
    play.street.look_all_round();
    play.street.sweep_s = sweep_s;
    play.street.known.push_back({{-40.0, 0.0, M_PI / 2.0}, 120.0, 1.0});
    const auto scene = [](Street& street, double t) {
      street.unknown = {{{-10.0, -15.0 + 10.0 * t, M_PI / 2.0}, 4.5, 1.8, {0.0, 10.0}}};
    };
    for (int i = 0; i < 30; ++i) {
      play.step(scene);
      if (play.now_s() < 1.0) continue;
      ASSERT_EQ(play.confirmed().size(), 1U) << play.now_s();
      const flow::TrackedObject car = play.confirmed().front();
      const Vector2 centre_m(-10.0, -15.0 + 10.0 * (play.now_s() - kSlowPeriodS));
      EXPECT_LT((car.position_in_odom_m - centre_m).norm(), 0.3) << play.now_s();
      EXPECT_LT((car.velocity_in_odom_mps - Vector2(0.0, 10.0)).norm(), 0.5) << play.now_s();
      ASSERT_FALSE(car.predicted_path.empty());
      EXPECT_LT((car.predicted_path.front().position_in_odom_m - centre_m -
                 Vector2(0.0, 10.0 * car.predicted_path.front().after_s))
                    .norm(),
                0.6);
      for (const Eigen::Vector2f& point_m : car.contour_in_odom_m)
        EXPECT_LT(std::abs(point_m.y() - centre_m.y()), 2.5) << play.now_s();
    }
    EXPECT_EQ(play.ids.size(), 1U);
  }
}

TEST(Tracker, IsSureOfACarWithinHalfASecond) {
  Play play;
  play.run(1.5, [](Street&, double) {});  // what was there before
  int scans = 0;
  for (; play.confirmed().empty() && scans < 40; ++scans)
    play.step([](Street& street, double t) {
      street.unknown = {{{25.0, -12.0 + 8.0 * (t - 1.5), M_PI / 2.0}}};
    });
  EXPECT_LT(scans * kPeriodS, 0.5);
}

TEST(Tracker, NeverBelievesInAWallThatTheMapHoldsToBeFree) {
  Play play;
  const StreetBox forgotten{{15.0, 8.0, 0.0}, 10.0, 0.5};
  play.run(4.0, [&](Street& street, double) { street.unknown = {forgotten}; });
  EXPECT_TRUE(play.ids.empty());
  std::size_t moving = 0;
  for (const flow::PointLabel label : play.result.labels.labels)
    moving += label == flow::PointLabel::kMoving ? 1 : 0;
  EXPECT_EQ(moving, 0U);  // so that the map learns it
}

TEST(Tracker, NeverBelievesInTheEndOfAWallThatComesIntoView) {
  Play play;  // a van drives off and uncovers, bit by bit, a wall of which the map knows nothing
  play.run(3.0, [&](Street& street, double t) {
    street.unknown = {{{20.0, 8.0, M_PI / 2.0}, 10.0, 0.5},
                      {{12.0, 5.0 + 2.0 * t, M_PI / 2.0}, 5.0, 2.0}};
  });
  ASSERT_FALSE(play.confirmed().empty()) << "the van";
  for (const flow::TrackedObject& object : play.confirmed())
    EXPECT_LT(object.position_in_odom_m.x(), 15.0);
}

TEST(Tracker, FollowsACarThatStoodInTheMapAndStartsOff) {
  Play play;
  const StreetBox parked{{15.0, 0.0, 0.0}};
  play.run(2.0, [&](Street& street, double) { street.known = {kWall, parked}; });
  EXPECT_TRUE(play.ids.empty());
  play.run(3.0, [&](Street& street, double t) {
    street.known = {kWall};
    street.gone = {parked};
    street.unknown = {{{15.0 + 0.75 * (t - 2.0) * (t - 2.0), 0.0, 0.0}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.x(), 4.5, 0.6);
}

TEST(Tracker, NoticesACarAheadThatCreepsOffBeforeItHasComeHalfAMetre) {
  Play play;
  const auto travelled_m = [](double t) { return 0.5 * std::pow(std::max(0.0, t - 2.0), 2); };
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, {{14.0 + travelled_m(t), 0.0, 0.0}}};
  };  // the map learns at once
  play.run(2.0, scene);
  EXPECT_TRUE(play.ids.empty());
  while (play.confirmed().empty() && play.now_s() < 4.0) play.step(scene);
  EXPECT_LT(travelled_m(play.now_s() - kPeriodS), 0.5);
}

TEST(Tracker, PredictsAndPublishesItsTracksAtABlankScan) {
  Play play;
  play.run(3.0, [](Street& street, double t) {
    street.known = {kWall};
    street.unknown = {{{8.0 + 3.0 * t, 2.0, 0.0}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  const double before_m = play.confirmed().front().position_in_odom_m.x();
  flow::SegmentedScan blank;
  blank.stamp_ns = static_cast<std::int64_t>(play.now_s() * 1e9);
  play.result = play.tracker().step(blank);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().position_in_odom_m.x() - before_m, 3.0 * kPeriodS, 0.02);
  EXPECT_TRUE(play.result.labels.labels.empty());
  blank.stamp_ns += 1'000'000'000;
  play.result = play.tracker().step(blank);
  EXPECT_TRUE(play.confirmed().empty()) << "blank for longer than a track is published unseen";
}

TEST(Tracker, NoticesATruckAheadThatCreepsOffThoughItsBackMightBeAShortFlank) {
  Play play;
  const auto travelled_m = [](double t) { return 0.5 * std::pow(std::max(0.0, t - 2.0), 2); };
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, {{6.6 + travelled_m(t), 0.0, 0.0}, 7.1, 2.4}};
  };
  play.run(2.0, scene);
  while (play.confirmed().empty() && play.now_s() < 6.0) play.step(scene);
  EXPECT_LT(travelled_m(play.now_s() - kPeriodS), 0.5);
}

TEST(Tracker, NoticesACarAheadThatCreepsOffThoughAPostHidesTheMiddleOfItsRear) {
  Play play;
  const auto travelled_m = [](double t) { return 0.5 * std::pow(std::max(0.0, t - 2.0), 2); };
  const StreetBox post{{3.0, 0.0, 0.0}, 0.2, 0.36};
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, post, {{9.75 + travelled_m(t), 0.0, 0.0}}};
  };
  play.run(2.0, scene);
  while (play.confirmed().empty() && play.now_s() < 5.0) play.step(scene);
  EXPECT_LT(travelled_m(play.now_s() - kPeriodS), 0.5);
}

TEST(Tracker, NoticesSoonThatACarCreepsThatComesIntoView) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall, {{14.0 + 0.9 * t, 0.0, 0.0}}};
    if (t < 2.0) street.known.push_back({{8.0, 0.0, M_PI / 2.0}, 6.0, 1.0});
  };
  play.run(2.0, scene);
  while (play.confirmed().empty() && play.now_s() < 5.0) play.step(scene);
  EXPECT_LT(play.now_s(), 2.7);
}

TEST(Tracker, KeepsWhatItIsSureOfThoughThatIsAsSlowAsWhatStops) {
  Play play;  // the two ends of a rear, at less than 0.6 m/s
  const StreetBox post{{3.0, 0.0, 0.0}, 0.2, 0.36};
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, post, {{9.75 + 0.2 * std::pow(std::max(0.0, t - 2.0), 2), 0.0, 0.0}}};
  };
  play.run(2.0, scene);
  play.run(3.0, scene);
  EXPECT_FALSE(play.confirmed().empty());
  EXPECT_EQ(play.tracker().counters().tracks_begun, 2U);
}

TEST(Tracker, TakesAWallBesideSomeoneWhoWalksForNoPartOfThem) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall, {{15.0, 3.5, M_PI / 2.0}, 3.0, 0.5}};
    street.unknown = {{{14.3, -3.0 + 1.4 * t, M_PI / 2.0}, 0.5, 0.5}};
  };
  play.run(6.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_LT(play.confirmed().front().length_m, 1.0);
  EXPECT_LT((play.confirmed().front().position_in_odom_m -
             Vector2(14.3, -3.0 + 1.4 * (play.now_s() - kPeriodS)))
                .norm(),
            0.4);
}

TEST(Tracker, DoesNotPublishTheVelocityOfOneForAnotherThatComesOutWhereItWasHidden) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall};
    street.unknown = {{{16.0, -9.0 + 6.0 * t, M_PI / 2.0}}};
    if (t > 1.5) street.known = {kWall, {{9.0, 3.0, M_PI / 2.0}, 14.0, 2.0}};
    if (t > 1.5) street.unknown = {};
    if (t > 2.4) street.known = {kWall};
    if (t > 2.4)
      street.unknown = {{{16.0, 9.3 - 5.0 * (t - 2.4), -M_PI / 2.0}}};  // it has turned off; one
                                                                        // comes towards
  };
  play.run(1.4, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.y(), 6.0, 1.0);
  play.run(1.0, scene);
  int wrong = 0;
  for (int i = 0; i < 30; ++i) {
    play.step(scene);
    for (const flow::TrackedObject& object : play.confirmed())
      wrong += object.velocity_in_odom_mps.y() > 0.0 ? 1 : 0;
  }
  EXPECT_LE(wrong, 3);
}

TEST(Tracker, TakesTheWallBehindWhichSomeoneDisappearsForNoPartOfThem) {
  Play play;
  const auto scene = [](Street& street, double t) {
    const double y_m = -3.0 + 1.2 * t;
    street.known = {kWall, {{15.0, 3.4, M_PI / 2.0}, 3.0, 0.5}};
    street.unknown = {{{15.0 + 0.2 * std::max(0.0, t - 2.5), y_m, M_PI / 2.0}, 0.5, 0.5}};
  };
  play.run(3.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  for (int i = 0; i < 100; ++i) {
    play.step(scene);
    for (const flow::TrackedObject& object : play.confirmed())
      EXPECT_LT(object.length_m, 1.2) << play.now_s();
  }
}

TEST(Tracker, DoesNotStayAtAWallThatSomeoneSlowHasWalkedTo) {
  Play play;
  constexpr double kGoneAfterS = 2.2;  // through a door
  const auto scene = [](Street& street, double t) {
    street.known = {kWall, {{15.0, 0.5, M_PI / 2.0}, 1.0, 0.5}};
    street.unknown = {};
    if (t < kGoneAfterS) street.unknown = {{{14.5, -1.9 + 0.8 * t, M_PI / 2.0}, 0.5, 0.5}};
  };
  play.run(kGoneAfterS - 0.1, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  play.run(0.2, scene);
  for (int i = 0; i < 60; ++i) {
    play.step(scene);
    EXPECT_TRUE(play.confirmed().empty()) << play.now_s();
  }
}

TEST(Tracker, DrawsNoVehicleAroundThoseWhoWalkSideBySide) {
  Play play;
  const auto scene = [](Street& street, double t) {
    const double apart_m = std::max(0.58, 1.4 - 0.5 * std::max(0.0, t - 1.2));  // they close up
    street.known = {kWall};
    street.unknown = {};
    for (const int i : {-1, 0, 1})
      street.unknown.push_back({{10.0 - 1.3 * t + 0.1 * i, 3.0 + i * apart_m, 0.0}, 0.35, 0.5});
  };
  play.run(1.2, scene);
  ASSERT_EQ(play.confirmed().size(), 3U);
  while (play.now_s() < 5.0) {
    play.step(scene);
    for (const flow::TrackedObject& object : play.confirmed())
      EXPECT_LT(object.length_m, 1.2) << play.now_s();
    EXPECT_GE(play.confirmed().size(), 2U) << play.now_s();
  }
}

TEST(Tracker, IsUnsureWhereTheMiddleIsOfWhatMayBeTheCornerOfACar) {
  Play play;  // as small as a corner, and at 6 m/s, though nothing is there that would hide the
              // rest
  const auto scene = [](Street& street, double t) {
    const double y_m = -12.0 + 6.0 * t;
    street.known = {kWall};
    street.unknown = {{{20.0, y_m, M_PI / 2.0}, 0.4, 0.4}};
  };
  play.run(2.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackedObject corner = play.confirmed().front();
  EXPECT_GT(corner.class_probability[2] + corner.class_probability[3], 0.1);
  EXPECT_GT(corner.covariance(1, 1), 1.0);  // along its way
}

TEST(Tracker, NoticesACarThatCreepsHoweverFastTheMapLearns) {
  Play play;  // its front comes, its flank slides along itself, and nothing contradicts the map
  const auto creeps = [](Street& street, double t) {
    street.known = {kWall, {{14.0 - 0.8 * std::max(0.0, t - 2.0), 4.0, M_PI}}};
  };
  play.run(2.0, creeps);
  EXPECT_TRUE(play.ids.empty());
  play.run(3.0, creeps);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.x(), -0.8, 0.2);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.y(), 0.0, 0.2);
}

TEST(Tracker, IsSureOfACarThatComesOutFromBehindABusBeforeEarlierScansTellItsSpeed) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{12.0, 6.0 + 5.0 * t, M_PI / 2.0}, 16.0, 2.5},
                      {{20.0, 22.0 - 7.0 * t, -M_PI / 2.0}}};
  };
  constexpr double kComesOutAtS = 1.61;  // with three echoes
  const auto is_sure = [&] {
    return std::ranges::any_of(play.confirmed(), [](const flow::TrackedObject& object) {
      return object.position_in_odom_m.x() > 17.0 && object.velocity_in_odom_mps.y() < -3.0;
    });
  };
  while (!is_sure() && play.now_s() < 4.0) play.step(scene);
  EXPECT_LT(play.now_s() - kComesOutAtS, 0.23);
}

TEST(Tracker, DoesNotLetABusOfWhichItSeesTheBackSwingRound) {
  Play play;
  const StreetBox standing{{18.0, 1.0, 0.0}, 12.0, 2.5};
  play.run(2.0, [&](Street& street, double) { street.known = {kWall, standing}; });
  int scans = 0;
  const auto starts = [&](Street& street, double t) {
    street.known = {kWall};
    street.gone = {standing};
    street.unknown = {
        {{18.0 + 0.5 * (t - 2.0) * (t - 2.0), 1.0 + 0.02 * (scans % 3 - 1), 0.0}, 12.0, 2.5}};
  };
  for (; scans < 190; ++scans) {
    play.step(starts);
    for (const flow::TrackedObject& bus : play.confirmed()) {
      ASSERT_LT(std::abs(std::sin(bus.heading_in_odom_rad)), 0.2) << play.now_s();
      ASSERT_LT(std::abs(bus.velocity_in_odom_mps.y()), 0.6) << play.now_s();
    }
  }
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.x(), 5.0, 0.6);
  EXPECT_GT(play.confirmed().front().length_m, 6.0);
}

TEST(Tracker, DropsSoonWhatStandsAndHasHardlyComeAnywhere) {
  Play play;  // a car rolls 1.2 m and stays
  play.run(2.0, [](Street& street, double) { street.known = {kWall}; });
  const auto rolls = [](Street& street, double t) {
    street.unknown = {{{14.0 - std::min(1.2, 1.2 * (t - 2.0)), 4.0, M_PI}}};
  };
  play.run(1.5, rolls);
  play.run(4.0, rolls);
  EXPECT_TRUE(play.confirmed().empty());
}

TEST(Tracker, KeepsWhatHasComeOutOfTheMapThoughItsTrackHasEnded) {
  Play play;  // a car rolls 1.2 m and stays
  const StreetBox parked{{12.8, 4.0, M_PI}};
  play.run(2.0, [](Street& street, double) { street.known = {kWall}; });
  play.run(9.0, [&](Street& street, double t) {
    street.unknown = {{{14.0 - std::min(1.2, 1.2 * (t - 2.0)), 4.0, M_PI}}};
  });
  ASSERT_EQ(play.ids.size(), 1U);
  ASSERT_TRUE(play.confirmed().empty());
  int of_car = 0;
  for (std::size_t beam = 0; beam < play.result.labels.labels.size(); ++beam) {
    const double direction_rad =
        -0.5 * M_PI + static_cast<double>(beam) * M_PI / (play.street.beams - 1);
    if (!testing::range_to(parked, Vector2::Zero(), direction_rad)) continue;
    ++of_car;
    EXPECT_EQ(play.result.labels.labels[beam], flow::PointLabel::kMoving) << beam;
  }
  EXPECT_GT(of_car, 10);
}

TEST(Tracker, LetsGoOfWhoCameToAPostThatTheMapKnows) {
  Play play;
  const StreetBox post{{12.0, 6.0, 0.0}, 0.3, 0.3};
  // Somebody walks up to the post and is gone; the post sends echoes at every scan.
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, post};
    street.unknown.clear();
    if (t < 4.0) street.unknown = {{{12.0, 0.4 + 1.3 * t, M_PI / 2.0}, 0.4, 0.4}};
  };
  play.run(4.0, scene);
  EXPECT_EQ(play.confirmed().size(), 1U);
  play.run(4.0, scene);
  EXPECT_TRUE(play.confirmed().empty());
}

TEST(Tracker, FollowsWhatDrivesToWhereTheMapStillHasSomethingThatLeft) {
  Play play;
  const auto position_m = [](double t) { return Vector2(10.0 + 6.0 * t, 2.0); };
  const auto scene = [&](Street& street, double t) {
    street.unknown = {{{position_m(t).x(), position_m(t).y(), 0.0}}};
    street.gone = {{{25.0, 2.0, 0.0}, 6.0, 2.2}};
  };
  play.run(3.5, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, KnowsSomebodyAgainWhoWasHidden) {
  Play play;
  play.street.known.push_back({{12.0, 0.0, M_PI / 2.0}, 2.0, 1.0});
  bool was_hidden = false;
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{16.0, -5.0 + 1.5 * t, M_PI / 2.0}, 0.4, 0.5}};
  };
  for (int i = 0; i < 230; ++i) {
    play.step(scene);
    was_hidden = was_hidden || (i > 80 && play.confirmed().empty());
  }
  EXPECT_TRUE(was_hidden);
  EXPECT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, TurnsTheVelocityOfACarInABendWithItsSides) {
  Play play;
  constexpr double kRateRadps = 0.6;
  constexpr double kRadiusM = 10.0;
  const auto heading_at = [](double t) { return M_PI / 2.0 + kRateRadps * std::max(0.0, t - 1.0); };
  const auto scene = [&](Street& street, double t) {
    const double heading_rad = heading_at(t);
    const double straight_m = kRadiusM * kRateRadps * std::min(0.0, t - 1.0);
    street.unknown = {{{8.0 + kRadiusM * std::sin(heading_rad),
                        straight_m - 6.0 - kRadiusM * std::cos(heading_rad), heading_rad}}};
  };
  play.run(1.0, scene);
  while (play.now_s() < 3.0) {
    play.step(scene);
    ASSERT_EQ(play.confirmed().size(), 1U);
    const double heading_rad = heading_at(play.now_s() - kPeriodS);
    const Vector2 across{-std::sin(heading_rad), std::cos(heading_rad)};
    ASSERT_LT(std::abs(across.dot(play.confirmed().front().velocity_in_odom_mps)), 0.7)
        << play.now_s();
  }
}

TEST(Tracker, HoldsACarThatRoundsABendToTurnIfThatIsAMode) {
  TrackingConfig config;
  config.motion.coordinated_turn = true;
  Play play(config);
  constexpr double kRateRadps = 0.5;
  constexpr double kRadiusM = 16.0;
  const auto heading_at = [](double t) { return M_PI / 2.0 + kRateRadps * std::max(0.0, t - 1.0); };
  play.run(4.0, [&](Street& street, double t) {
    const double heading_rad = heading_at(t);
    const double straight_m = kRadiusM * kRateRadps * std::min(0.0, t - 1.0);
    street.unknown = {{{8.0 + kRadiusM * std::sin(heading_rad),
                        straight_m - 6.0 - kRadiusM * std::cos(heading_rad), heading_rad}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackedObject car = play.confirmed().front();
  const double heading_rad = heading_at(play.now_s() - kPeriodS);
  EXPECT_LT((car.velocity_in_odom_mps -
             kRadiusM * kRateRadps * Vector2(std::cos(heading_rad), std::sin(heading_rad)))
                .norm(),
            0.8);
  EXPECT_GT(car.mode_probability[2], 0.0);
  EXPECT_NEAR(car.mode_probability[0] + car.mode_probability[1] + car.mode_probability[2], 1.0,
              1e-9);
}

/// How far off the tracker holds the middle of three cars to be, when it comes out from behind a
/// container: the queue brakes from 8 to 2 m/s while it is hidden.
double error_behind_a_container_m(bool formations) {
  TrackingConfig config;
  config.motion.formations = formations;
  Play play(config);
  const StreetBox container{{10.0, 0.0, M_PI / 2.0}, 4.5, 1.0};
  const auto travelled_m = [](double t) {
    const double braking = std::clamp(t - 2.4, 0.0, 2.0);
    return 8.0 * std::min(t, 2.4) + 8.0 * braking - 1.5 * braking * braking +
           2.0 * std::max(0.0, t - 4.4);
  };
  constexpr double kApartM = 13.0;
  const auto y_of = [&](int car, double t) { return -23.0 - kApartM * (car - 1) + travelled_m(t); };
  const auto scene = [&](Street& street, double t) {
    street.known = {kWall, container};
    street.unknown.clear();
    for (int car = 0; car < 3; ++car) street.unknown.push_back({{20.0, y_of(car, t), M_PI / 2.0}});
  };
  play.run(2.0, scene);
  std::uint32_t middle = 0;
  for (const flow::TrackedObject& object : play.confirmed())
    if (std::abs(object.position_in_odom_m.y() - y_of(1, play.now_s() - kPeriodS)) < 2.0)
      middle = object.track_id.value;
  double worst_m = 0.0;
  while (play.now_s() < 5.0) {
    play.step(scene);
    const double truth_m = y_of(1, play.now_s() - kPeriodS);
    for (const flow::TrackedObject& object : play.result.objects.objects)
      if (object.track_id.value == middle)
        worst_m = std::max(worst_m, std::abs(object.position_in_odom_m.y() - truth_m));
  }
  return worst_m;
}

TEST(Tracker, KnowsWhereAHiddenCarOfAQueueIsByTheOthers) {
  const double apart_m = error_behind_a_container_m(false);
  const double together_m = error_behind_a_container_m(true);
  EXPECT_LT(together_m, 0.5 * apart_m);
  EXPECT_LT(together_m, 0.8);
}

TEST(Tracker, HoldsTheTwoEndsOfACarForOneWhileSomethingHidesItsMiddle) {
  Play play;  // who rides before it at half the distance and half the speed
  const auto scene = [](Street& street, double t) {
    const double y_m = -9.0 + 6.0 * t;
    street.unknown = {{{20.0, y_m, M_PI / 2.0}}, {{10.0, 0.5 * y_m, M_PI / 2.0}, 1.2, 0.5}};
  };
  play.run(2.5, scene);
  std::vector<flow::TrackedObject> far;
  for (const flow::TrackedObject& object : play.confirmed())
    if (object.position_in_odom_m.x() > 15.0) far.push_back(object);
  ASSERT_EQ(far.size(), 1U);
  EXPECT_LT((far.front().position_in_odom_m - Vector2(20.0, -9.0 + 6.0 * (play.now_s() - kPeriodS)))
                .norm(),
            0.4);
  EXPECT_GT(far.front().length_m, 4.0);
}

TEST(Tracker, HoldsTheBackAndTheFlankOfATruckForOneWhileARiderHidesTheEdgeBetweenThem) {
  Play play;  // at half the distance and half the speed
  const auto scene = [](Street& street, double t) {
    const double x_m = 6.0 + 6.0 * t;
    street.unknown = {{{x_m, 4.0, 0.0}, 7.0, 2.2}, {{0.5 * x_m, 2.0, 0.0}, 1.2, 0.5}};
  };
  play.run(2.5, scene);
  EXPECT_EQ(play.confirmed().size(), 2U);  // with the rider
}

TEST(Tracker, KeepsTwoCyclistsApartBetweenWhichItSeesTheWall) {
  Play play;
  const auto scene = [](Street& street, double t) {
    const double y_m = -9.0 + 6.0 * t;
    street.unknown = {{{20.0, y_m, M_PI / 2.0}, 1.7, 0.6},
                      {{20.0, y_m + 2.9, M_PI / 2.0}, 1.7, 0.6}};
  };
  play.run(2.5, scene);
  EXPECT_EQ(play.confirmed().size(), 2U);
}

TEST(Tracker, KnowsACarAgainThatWasHiddenForThreeSeconds) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall};
    street.unknown = {{{24.0, -17.0 + 6.0 * t, M_PI / 2.0}}};
    if (t > 1.5) street.known.push_back({{10.0, 1.0, M_PI / 2.0}, 9.0, 1.0});
  };
  play.run(1.4, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackId car = play.confirmed().front().track_id;
  int hidden = 0;
  double sigma_m = 0.0;
  while (play.now_s() < 6.5) {
    play.step(scene);
    hidden += play.confirmed().empty() ? 1 : 0;
    if (!play.occluded().empty())
      sigma_m = std::sqrt(play.occluded().front().covariance.topLeftCorner<2, 2>().trace());
  }
  EXPECT_GT(hidden, 100);
  EXPECT_GT(sigma_m, 1.0) << "grows while it is hidden";
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.confirmed().front().track_id, car);
  EXPECT_EQ(play.ids.size(), 1U);
  EXPECT_EQ(play.tracker().counters().tracks_found_again, 1U);
}

TEST(Tracker, GivesAnotherIdentityToWhatComesOutElsewhereThanTheHiddenOneCanBe) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall};
    street.unknown = {{{24.0, -17.0 + 6.0 * t, M_PI / 2.0}}};
    if (t > 1.5) street.known.push_back({{10.0, 1.0, M_PI / 2.0}, 9.0, 1.0});
    if (t > 1.6) street.unknown = {};
    if (t > 3.5) street.unknown = {{{24.0, 20.0 - 6.0 * (t - 3.5), -M_PI / 2.0}}};  // oncoming
  };
  play.run(1.4, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackId car = play.confirmed().front().track_id;
  while (play.now_s() < 4.3) play.step(scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NE(play.confirmed().front().track_id, car);
  EXPECT_EQ(play.tracker().counters().tracks_found_again, 0U);
}

TEST(Tracker, KnowsACarAgainThatDroveBehindAVan) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.known = {kWall};
    street.unknown = {{{20.0, -15.0 + 8.0 * t, M_PI / 2.0}}};
    if (t > 1.0)
      street.known.push_back({{10.0, 0.0, M_PI / 2.0}, 6.0, 1.0});  // hides the car for more than a
                                                                    // second
  };
  play.run(1.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackId car = play.confirmed().front().track_id;
  int hidden = 0;
  int expected = 0;
  for (int scans = 0; scans < 75; ++scans) {
    play.step(scene);
    hidden += play.confirmed().empty() ? 1 : 0;
    for (const flow::TrackedObject& object : play.occluded()) {
      expected += object.track_id == car ? 1 : 0;
      EXPECT_NEAR(object.position_in_odom_m.x(), 20.0, 1.5);  // its width is not known
      EXPECT_NEAR(object.position_in_odom_m.y(), -15.0 + 8.0 * (play.now_s() - kPeriodS), 1.0);
    }
  }
  EXPECT_GT(hidden, 20);
  EXPECT_EQ(expected, hidden);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.confirmed().front().track_id, car);
}

TEST(Tracker, KeepsTheFrontOfATruckWhereItIsSeenThoughItMightBeABus) {
  for (const double width_m : {2.40, 2.43, 2.46, 2.49}) {
    Play play;  // it comes round a slight bend, so that it is turned and measured again and again
    int scans = 0;
    const auto scene = [&](Street& street, double t) {
      const double heading_rad = M_PI + 0.25 - 0.12 * t;
      street.unknown = {{{36.0 - 8.0 * t, 4.0, heading_rad}, 7.1, width_m}};
    };
    for (; scans < 110; ++scans) {
      play.step(scene);
      if (scans < 40) continue;
      ASSERT_EQ(play.confirmed().size(), 1U) << width_m << " at " << play.now_s();
      const flow::TrackedObject truck = play.confirmed().front();
      const double t = play.now_s() - kPeriodS;
      const double heading_rad = M_PI + 0.25 - 0.12 * t;
      const Vector2 front_m = Vector2(36.0 - 8.0 * t, 4.0) +
                              3.55 * Vector2(std::cos(heading_rad), std::sin(heading_rad));
      const Vector2 seen_m =
          truck.position_in_odom_m +
          0.5 * truck.length_m *
              Vector2(std::cos(truck.heading_in_odom_rad), std::sin(truck.heading_in_odom_rad));
      EXPECT_LT((seen_m - front_m).norm(), 0.5) << width_m << " at " << play.now_s();
    }
    EXPECT_EQ(play.ids.size(), 1U) << width_m;
  }
}

TEST(Tracker, StopsWithWhatStopsAndKeepsIt) {
  Play play;  // 8 m/s, brakes at 2 m/s^2 from t = 1 s on, stands from t = 5 s on
  const auto y_of = [](double t) {
    const double braking = std::clamp(t - 1.0, 0.0, 4.0);
    return -15.0 + 8.0 * std::min(t, 1.0) + 8.0 * braking - braking * braking;
  };
  play.run(9.0, [&](Street& street, double t) {
    street.unknown = {{{20.0, y_of(t), M_PI / 2.0}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.confirmed().front().velocity_in_odom_mps.norm(), 0.0);
  EXPECT_EQ(play.confirmed().front().motion, flow::Motion::kStopped);
  EXPECT_NEAR((play.confirmed().front().predicted_path.back().position_in_odom_m -
               play.confirmed().front().position_in_odom_m)
                  .norm(),
              0.0, 0.1);
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, KnowsSoonAgainTheSpeedOfWhatDrivesOff) {
  Play play;  // stops at t = 3 s, drives off at 6 s with 2 m/s^2
  const auto y_of = [](double t) {
    const double braking = std::clamp(t - 1.0, 0.0, 2.0);
    const double starting = std::max(0.0, t - 6.0);
    return -8.0 + 4.0 * std::min(t, 1.0) + 4.0 * braking - braking * braking + starting * starting;
  };
  const auto scene = [&](Street& street, double t) {
    street.unknown = {{{20.0, y_of(t), M_PI / 2.0}}};
  };
  play.run(6.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.confirmed().front().velocity_in_odom_mps.norm(), 0.0);
  play.run(1.0, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.y(), 2.0, 0.6);
  EXPECT_EQ(play.confirmed().front().motion, flow::Motion::kMoving);
}

TEST(Tracker, DoesNotTakeAParkedCarForOneThatLeavesTheView) {
  Play play;
  play.street.known.push_back({{6.0, 9.0, 0.0}});
  play.run(4.0, [](Street& street, double t) { street.unknown = {{{14.0 - 8.0 * t, 5.5, M_PI}}}; });
  EXPECT_TRUE(play.confirmed().empty());
}

TEST(Tracker, FindsTheSameToTheLastBitWithHelp) {
  slammot::testing::HelpAtTheLastMoment help;
  Play helped({}, kPeriodS, &help);
  Play alone;
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{8.0 + 6.0 * t, 5.0, 0.0}},
                      {{34.0 - 9.0 * t, -4.0, M_PI}},
                      {{14.0 - 1.3 * t, 0.2, 0.0}, 0.3, 0.3}};
  };
  for (int i = 0; i < 100; ++i) {
    helped.step(scene);
    alone.step(scene);
    ASSERT_EQ(helped.result.labels.labels, alone.result.labels.labels);
    ASSERT_EQ(helped.result.objects.objects.size(), alone.result.objects.objects.size());
    for (std::size_t k = 0; k < alone.result.objects.objects.size(); ++k) {
      const flow::TrackedObject& a = helped.result.objects.objects[k];
      const flow::TrackedObject& b = alone.result.objects.objects[k];
      ASSERT_EQ(a.track_id, b.track_id);
      ASSERT_EQ(a.confirmed, b.confirmed);
      ASSERT_EQ(a.position_in_odom_m, b.position_in_odom_m);
      ASSERT_EQ(a.covariance, b.covariance);
      ASSERT_EQ(a.length_m, b.length_m);
    }
  }
  EXPECT_GT(alone.ids.size(), 1U);
  EXPECT_GT(help.shared(), 100);
}

TEST(Tracker, HoldsTwoLegsForOneWhoWalks) {
  Play play;
  play.run(4.0, [](Street& street, double t) {
    const double swing_m = 0.25 * std::sin(2.0 * M_PI * t);
    const double x_m = 14.0 - 1.3 * t;
    street.unknown = {{{x_m + swing_m, 0.2, 0.0}, 0.15, 0.15},
                      {{x_m - swing_m, -0.1, 0.0}, 0.15, 0.15}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.confirmed().front().object_class, flow::ObjectClass::kPedestrian);
  EXPECT_NEAR(play.confirmed().front().velocity_in_odom_mps.x(), -1.3, 0.3);
}

TEST(Tracker, IsSureSoonOfSomebodyWhoWalksWhereAnotherHasJustBeen) {
  Play play = hall();
  constexpr double kFirstSeenS = 1.0;
  constexpr double kSecondSeenS = 1.8;  // dark legs until then
  const auto x_of = [](int who, double t) { return 7.0 + 1.2 * who - 1.4 * t; };
  const auto scene = [&](Street& street, double t) {
    street.unknown.clear();
    for (const int who : {0, 1})
      if (t >= (who == 0 ? kFirstSeenS : kSecondSeenS))
        for (const StreetBox& leg : legs_at(x_of(who, t), 0.3 * who, t + 0.3 * who))
          street.unknown.push_back(leg);
  };
  const auto knows = [&](int who) {
    const Vector2 place_m{x_of(who, play.now_s()), 0.3 * who};
    const auto confirmed = play.confirmed();
    return std::any_of(confirmed.begin(), confirmed.end(), [&](const auto& one) {
      return (one.position_in_odom_m - place_m).norm() < 0.6;
    });
  };
  while (!knows(1) && play.now_s() < 4.0) play.step(scene);
  EXPECT_LT(play.now_s() - kSecondSeenS, 0.8);
}

TEST(Tracker, NeverBelievesInAWallInTheOpenThatAnswersBitByBit) {
  Play play = hall();
  play.run(1.5, [](Street&, double) {});
  play.run(2.0, [](Street& street, double t) {
    const double length_m = std::min(1.8, 0.3 + 1.5 * (t - 1.5));
    street.unknown = {{{6.0, 0.5 * length_m - 0.5, M_PI / 2.0}, length_m, 0.1}};
  });
  EXPECT_TRUE(play.ids.empty());
}

TEST(Tracker, GoesOnWithTheSameIdsAfterARestart) {
  Play play;
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{20.0, -15.0 + 8.0 * t, M_PI / 2.0}}};
  };
  play.run(1.5, scene);
  ASSERT_EQ(play.confirmed().size(), 1U);
  play.tracker().resume(play.result.objects);
  play.run(1.0, scene);
  EXPECT_EQ(play.confirmed().size(), 1U);
  EXPECT_EQ(play.ids.size(), 1U);
}

TEST(Tracker, TellsTheSameWhenAskedTwice) {
  const auto scene = [](Street& street, double t) {
    street.unknown = {{{20.0, -15.0 + 8.0 * t, M_PI / 2.0}}, {{12.0 - t, 3.0, 0.0}, 0.4, 0.5}};
  };
  Play first, second;
  first.run(2.0, scene);
  second.run(2.0, scene);
  ASSERT_EQ(first.result.objects.objects.size(), second.result.objects.objects.size());
  for (std::size_t i = 0; i < first.result.objects.objects.size(); ++i) {
    EXPECT_EQ(first.result.objects.objects[i].track_id, second.result.objects.objects[i].track_id);
    EXPECT_EQ(first.result.objects.objects[i].position_in_odom_m,
              second.result.objects.objects[i].position_in_odom_m);
  }
  EXPECT_EQ(first.result.labels.labels, second.result.labels.labels);
}

TEST(Tracker, LabelsAScanFromThePastAsDetectionDid) {
  Play play;
  play.run(0.5, [](Street&, double) {});
  const flow::SegmentedScan old = detection::detect(play.street.scan(0, 0), {});
  EXPECT_EQ(play.tracker().step(old).labels.labels, old.labels);
  EXPECT_EQ(play.tracker().counters().late_scans, 1U);
}

TEST(Tracker, DoesNotExpectWhatBrakesToGoOnAsItGoes) {
  Play play;  // 10 m/s, brakes at 3 m/s^2 from t = 1 s on
  const auto y_of = [](double t) {
    const double braking = std::clamp(t - 1.0, 0.0, 10.0 / 3.0);
    return -15.0 + 10.0 * std::min(t, 1.0) + 10.0 * braking - 1.5 * braking * braking;
  };
  play.run(2.5, [&](Street& street, double t) {
    street.unknown = {{{20.0, y_of(t), M_PI / 2.0}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackedObject car = play.confirmed().front();
  ASSERT_EQ(car.predicted_path.size(), 6U);
  const flow::PredictedPosition& later = car.predicted_path[1];  // a second ahead
  const double truth_m = y_of(play.now_s() - kPeriodS + later.after_s);
  const double as_it_goes_m =
      car.position_in_odom_m.y() + later.after_s * car.velocity_in_odom_mps.y();
  EXPECT_LT(std::abs(later.position_in_odom_m.y() - truth_m),
            0.7 * std::abs(as_it_goes_m - truth_m));
  EXPECT_LT(std::abs(later.position_in_odom_m.y() - truth_m),
            2.0 * std::sqrt(later.covariance_m2(1, 1)));
}

TEST(Tracker, SaysWhereAnObjectWillBeAndHowSurely) {
  Play play;
  play.run(2.0, [](Street& street, double t) {
    street.unknown = {{{20.0, -15.0 + 8.0 * t, M_PI / 2.0}}};
  });
  ASSERT_EQ(play.confirmed().size(), 1U);
  const flow::TrackedObject car = play.confirmed().front();
  ASSERT_FALSE(car.predicted_path.empty());
  EXPECT_NEAR(car.predicted_path.back().after_s, 3.0, 1e-9);
  const Vector2 travelled_m = car.predicted_path.back().position_in_odom_m - car.position_in_odom_m;
  EXPECT_LT((travelled_m - 3.0 * car.velocity_in_odom_mps).norm(), 0.5);
  EXPECT_GT(car.predicted_path.back().covariance_m2.trace(),
            car.predicted_path.front().covariance_m2.trace());
}

/// A street before a front scanner and behind a rear one at the same place, each of half a circle.
/// They speak in turns, or together.
class PlayBeforeTwo {
 public:
  explicit PlayBeforeTwo(double delay_s) : delay_s_(delay_s), tracker_({}) {
    front.known = rear.known = {kWall, {{-40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}};
    rear.first_beam_rad = 0.5 * M_PI;
  }

  /// Lets a box that is not in the map move.
  void run(double seconds, const std::function<Vector2(double)>& centre_m) {
    for (int i = 0; i < std::lround(seconds / kPeriodS); ++i, ++sequence_) {
      look(front, "front", sequence_ * kPeriodS, centre_m);
      if (rear_speaks && sequence_ % rear_every == 0)
        look(rear, "rear", sequence_ * kPeriodS + delay_s_, centre_m);
      least_confirmed = std::min(least_confirmed, i * kPeriodS > 2.0 ? confirmed() : 1);
    }
  }

  std::size_t confirmed() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(result.objects.objects, &flow::TrackedObject::confirmed));
  }

  Tracker& tracker() { return tracker_; }

  Street front;
  Street rear;
  bool rear_speaks = true;
  std::uint32_t rear_every = 1;  ///< So many of the front one's scans.
  TrackingResult result;
  std::set<std::uint32_t> ids;      ///< Of all that were ever confirmed.
  double least_existence = 1.0;     ///< Of these.
  std::size_t least_confirmed = 1;  ///< In any scan, 2 s after a run began.

 private:
  void look(Street& street, const std::string& scanner_id, double now_s,
            const std::function<Vector2(double)>& centre_m) {
    street.unknown = {{{centre_m(now_s).x(), centre_m(now_s).y(), 0.0}, 4.5, 1.8}};
    flow::LocalizedScan scan = street.scan(static_cast<std::int64_t>(now_s * 1e9), sequence_);
    scan.scanner_id = scanner_id;
    result = tracker_.step(detection::detect(scan, {}));
    EXPECT_EQ(result.labels.scanner_id, scanner_id);
    for (const flow::TrackedObject& object : result.objects.objects) {
      if (!object.confirmed) continue;
      ids.insert(object.track_id.value);
      least_existence = std::min(least_existence, object.existence);
    }
  }

  double delay_s_;
  Tracker tracker_;
  std::uint32_t sequence_ = 0;
};

TEST(TrackerOfTwoScanners, DoesNotMissWithOneWhatOnlyTheOtherSees) {
  PlayBeforeTwo both(0.5 * kPeriodS);
  both.run(4.0, [](double now_s) { return Vector2(12.0 + 4.0 * now_s, 3.0); });
  PlayBeforeTwo alone(0.5 * kPeriodS);
  alone.rear_speaks = false;
  alone.run(4.0, [](double now_s) { return Vector2(12.0 + 4.0 * now_s, 3.0); });
  EXPECT_EQ(both.ids.size(), 1U);
  EXPECT_EQ(both.confirmed(), 1U);
  EXPECT_NEAR(both.least_existence, alone.least_existence, 1e-6);
}

TEST(TrackerOfTwoScanners, FollowsAVehicleFromTheViewOfOneIntoThatOfTheOther) {
  for (const double delay_s : {0.5 * kPeriodS, 0.0}) {
    PlayBeforeTwo play(delay_s);
    play.run(5.0, [](double now_s) { return Vector2(20.0 - 8.0 * now_s, 5.0); });
    EXPECT_EQ(play.ids.size(), 1U);
    EXPECT_EQ(play.confirmed(), 1U);
    EXPECT_EQ(play.tracker().counters().late_scans, 0U);
  }
}

TEST(TrackerOfTwoScanners, PublishesWhatOnlyTheRarerOneSeesAtEveryScan) {
  PlayBeforeTwo play(0.5 * kPeriodS);
  play.rear_every = 4;
  play.run(4.0, [](double now_s) { return Vector2(-10.0 - 3.0 * now_s, 3.0); });
  EXPECT_EQ(play.ids.size(), 1U);
  EXPECT_EQ(play.least_confirmed, 1U);
}

TEST(TrackerOfTwoScanners, GoesOnWithOneWhenTheOtherFallsSilent) {
  PlayBeforeTwo play(0.5 * kPeriodS);
  const auto in_front = [](double now_s) { return Vector2(10.0 + 3.0 * now_s, 3.0); };
  play.run(3.0, in_front);
  play.rear_speaks = false;
  play.run(3.0, in_front);
  EXPECT_EQ(play.ids.size(), 1U);
  EXPECT_EQ(play.confirmed(), 1U);
}

TEST(TrackerOfTwoScanners, EndsTracksThatOnlyTheSilentOneSaw) {
  PlayBeforeTwo play(0.5 * kPeriodS);
  const auto behind = [](double now_s) { return Vector2(-10.0 - 3.0 * now_s, 3.0); };
  play.run(3.0, behind);
  EXPECT_EQ(play.confirmed(), 1U);
  play.rear_speaks = false;
  play.run(TrackingConfig{}.existence.longest_unseen_s + 0.5, behind);
  EXPECT_EQ(play.confirmed(), 0U);
}

TEST(Tracker, TakesAScanOfTheSameStampAndScannerForLate) {
  PlayBeforeTwo play(0.0);
  play.run(0.1, [](double) { return Vector2(15.0, 3.0); });
  flow::LocalizedScan again = play.front.scan(play.result.labels.stamp_ns, 99);
  again.scanner_id = "front";
  play.tracker().step(detection::detect(again, {}));
  EXPECT_EQ(play.tracker().counters().late_scans, 1U);
}

}  // namespace
}  // namespace slammot::tracking
