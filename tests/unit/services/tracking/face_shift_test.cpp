#include "services/tracking/face_shift.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Vector2;
using testing::Street;
using testing::StreetBox;

constexpr double kPeriodS = 0.1;
constexpr int kScans = 20;
constexpr double kPoseSigmaM = 0.01;
const TrackingConfig kConfig;

struct Answer {
  std::optional<Vector2> shift_m;
  std::size_t beams = 0;
};

/// Of the thing at the place, after two seconds of a scene with noise of 2 cm, by scans of 0.4, 0.8
/// and 1.6 s before.
Answer shift_after(const std::function<std::vector<StreetBox>(double)>& boxes_at,
                   const Vector2& place_m, bool is_confirmed = false) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise_m(0.0, 0.02);
  ScanHistory history;
  Answer answer;
  for (int i = 0; i <= kScans; ++i) {
    Street street;
    street.known = boxes_at(i * kPeriodS);
    const auto stamp_ns = static_cast<std::int64_t>(std::llround(i * kPeriodS * 1e9));
    flow::LocalizedScan scan = street.scan(stamp_ns, static_cast<std::uint32_t>(i));
    for (flow::LocalizedBeam& beam : scan.beams) {
      if (beam.range_m <= 0.0F) continue;
      const auto range_m = static_cast<float>(beam.range_m + noise_m(random));
      beam.point_in_base_m *= range_m / beam.range_m;
      beam.range_m = range_m;
    }
    const flow::SegmentedScan segmented = detection::detect(scan, {});
    const PolarView view(segmented);
    if (i < kScans) {
      history.add(stamp_ns, view,
                  std::vector<Owner>(view.beam_count(), Owner{{1}, is_confirmed, is_confirmed}));
      continue;
    }
    std::vector<const EarlierScan*> earlier;
    for (const double age_s : {0.4, 0.8, 1.6})
      earlier.push_back(history.older_than(stamp_ns, age_s));
    for (const flow::Segment& segment : segmented.segments) {
      if ((segment.centroid_in_odom_m - place_m).norm() > 3.0) continue;
      for (const flow::Segment& other : segmented.segments) {
        if (&other == &segment || (other.centroid_in_odom_m - place_m).norm() > 3.0) continue;
        if (const auto shift = face_shift_with(
                other.beams, segment.beams, view, earlier, [] { return kPoseSigmaM; }, kConfig))
          answer = {shift->shift_m, shift->beams.size()};
      }
      if (const auto shift = face_shift(
              segment.beams, view, earlier, [] { return kPoseSigmaM; }, kConfig))
        answer = {shift->shift_m, shift->beams.size()};
    }
  }
  return answer;
}

TEST(FaceShift, TellsHowFarTheRearOfACarAheadHasComeThatCreepsOff) {
  const auto travelled_m = [](double t) {
    return 0.5 * std::pow(std::max(0.0, t - 1.2), 2);
  };  // 0.3 m by now, 0.08 m 0.4 s ago
  const Answer answer = shift_after(
      [&](double t) {
        return std::vector<StreetBox>{{{14.0 + travelled_m(t), 0.0, 0.0}}};
      },
      {12.0, 0.0});
  ASSERT_TRUE(answer.shift_m);
  EXPECT_NEAR(answer.shift_m->x(), travelled_m(2.0) - travelled_m(1.6), 0.03);
  EXPECT_NEAR(answer.shift_m->y(), 0.0, 0.02);
  EXPECT_GT(answer.beams, 10U);
}

TEST(FaceShift, TellsOfTheFrontAndNotOfTheFlankOfACarThatComes) {
  const Answer answer = shift_after(
      [](double t) {
        return std::vector<StreetBox>{{{12.0 - 0.5 * t, 4.0, 0.0}}};
      },
      {9.5, 3.5});
  ASSERT_TRUE(answer.shift_m);
  EXPECT_NEAR(answer.shift_m->x(), -0.2, 0.03);
  EXPECT_NEAR(answer.shift_m->y(), 0.0, 0.03);
}

const StreetBox kPost{{3.0, 0.0, 0.0}, 0.2, 0.36};

TEST(FaceShift, TellsByItsTwoEndsOfARearTheMiddleOfWhichIsHidden) {
  const Answer answer = shift_after(
      [](double t) {
        return std::vector<StreetBox>{kPost, {{9.0 + 0.4 * t, 0.0, 0.0}}};
      },
      {7.5, 0.0});
  ASSERT_TRUE(answer.shift_m);
  EXPECT_NEAR(answer.shift_m->x(), 0.16, 0.03);
  EXPECT_NEAR(answer.shift_m->y(), 0.0, 0.03);
  EXPECT_LT(answer.beams, 10U);
}

TEST(FaceShift, IsNoneOfTheTwoEndsOfWhatStands) {
  EXPECT_FALSE(shift_after(
                   [](double) {
                     return std::vector<StreetBox>{kPost, {{9.8, 0.0, 0.0}}};
                   },
                   {7.5, 0.0})
                   .shift_m);
}

TEST(FaceShift, IsNoneOfWhatStands) {
  EXPECT_FALSE(shift_after(
                   [](double) {
                     return std::vector<StreetBox>{{{14.0, 0.0, 0.3}}};
                   },
                   {12.0, 0.0})
                   .shift_m);
}

TEST(FaceShift, IsNoneOfWhatComesIntoViewBehindSomethingThatDrivesOff) {
  const auto boxes = [](double t) {
    return std::vector<StreetBox>{{{14.0, 0.0, 0.0}}, {{8.0, 0.5 + 1.5 * t, M_PI / 2.0}, 3.0, 1.0}};
  };
  EXPECT_FALSE(shift_after(boxes, {12.0, 0.0}).shift_m);
}

TEST(FaceShift, IsNotAskedAboutWhatIsKnownToMove) {
  EXPECT_FALSE(shift_after(
                   [](double t) {
                     return std::vector<StreetBox>{{{14.0 + 0.5 * t, 0.0, 0.0}}};
                   },
                   {12.5, 0.0}, true)
                   .shift_m);
}

}  // namespace
}  // namespace slammot::tracking
