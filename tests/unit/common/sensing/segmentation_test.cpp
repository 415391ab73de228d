#include "common/sensing/segmentation.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

constexpr double kStepRad = 0.5 * M_PI / 180.0;

/// Half a turn from the right to the left, with whatever is met in each direction.
struct Sweep {
  std::vector<Eigen::Vector2f> points_m;
  std::vector<float> range_m;

  template <typename RangeAt>
  explicit Sweep(RangeAt range_at) {
    for (int beam = 0; beam <= 360; ++beam) {
      const double angle = -0.5 * M_PI + beam * kStepRad;
      const std::optional<double> range = range_at(angle);
      range_m.push_back(static_cast<float>(range.value_or(0.0)));
      points_m.emplace_back(range.value_or(0.0) * std::cos(angle),
                            range.value_or(0.0) * std::sin(angle));
    }
  }
  std::vector<BeamSpan> spans(const SegmentationConfig& config = {}) const {
    std::vector<BeamSpan> spans;
    segment_by_distance(points_m, range_m, kStepRad, config, spans);
    return spans;
  }
};

TEST(Segmentation, CutsWhereARangeJumps) {
  const Sweep sweep(
      [](double angle) -> std::optional<double> { return angle < 0.0 ? 10.0 : 14.0; });
  const auto spans = sweep.spans();
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0].first, 0);
  EXPECT_EQ(spans[0].last + 1, spans[1].first);
  EXPECT_EQ(spans[1].last, 360);
}

TEST(Segmentation, KeepsAWallAtAGrazingAngleWhole) {
  // 2 m to the left, parallel to the direction of travel, up to 30 m ahead: there the echoes lie 4
  // m apart.
  const Sweep sweep([](double angle) -> std::optional<double> {
    return angle > 0.066 ? std::optional(2.0 / std::sin(angle)) : std::nullopt;
  });
  EXPECT_EQ(sweep.spans().size(), 1U);
}

TEST(Segmentation, BridgesBeamsWithoutEcho) {
  int beam = 0;
  const Sweep two([&](double) -> std::optional<double> {
    return ++beam == 100 || beam == 101 ? std::nullopt : std::optional(8.0);
  });
  EXPECT_EQ(two.spans().size(), 1U);
  beam = 0;
  const Sweep three([&](double) -> std::optional<double> {
    return ++beam >= 100 && beam <= 102 ? std::nullopt : std::optional(8.0);
  });
  EXPECT_EQ(three.spans().size(), 2U);
}

TEST(Segmentation, AllowsWiderGapsFartherAway) {
  // Two things half a metre apart: two at 5 m; at 40 m neighbouring beams are as far apart as that.
  const auto gap_at = [](double range_m) {
    return Sweep([=](double angle) -> std::optional<double> {
      return std::abs(angle) * range_m < 0.25 || std::abs(angle) * range_m > 2.0
                 ? std::nullopt
                 : std::optional(range_m);
    });
  };
  EXPECT_EQ(gap_at(5.0).spans().size(), 2U);
  EXPECT_EQ(gap_at(40.0).spans().size(), 1U);
}

/// Of a dark flank 10 m to the left every n-th beam is answered.
Sweep dark_flank(int every_nth, double step_back_m) {
  int beam = 0;
  return Sweep([=](double angle) mutable -> std::optional<double> {
    const double along_m = 10.0 * std::tan(angle);
    if (++beam % every_nth != 0 || along_m < 0.0 || along_m > 4.5) return std::nullopt;
    return (10.0 + (along_m > 2.0 ? step_back_m : 0.0)) / std::cos(angle);
  });
}

TEST(Segmentation, KeepsTogetherTheFewEchoesOfADarkFlank) {
  EXPECT_EQ(dark_flank(6, 0.0).spans().size(), 1U);
  EXPECT_GT(dark_flank(6, 0.0).spans({.gap_m = 0.05}).size(), 5U) << "half a metre apart";
}

TEST(Segmentation, DoesNotTakeScatteredEchoesForADarkFlank) {
  EXPECT_EQ(dark_flank(6, 1.0).spans().size(), 2U)
      << "a metre farther back there is something else";
  EXPECT_GT(dark_flank(16, 0.0).spans().size(), 1U) << "too far apart";
}

TEST(Segmentation, LeavesApartTwoWhoStandSideBySide) {
  // 10 m away, nothing behind them: each answers to all beams that meet it.
  const Sweep two([](double angle) -> std::optional<double> {
    return std::abs(std::abs(10.0 * angle) - 0.5) < 0.2 ? std::optional(10.0) : std::nullopt;
  });
  EXPECT_EQ(two.spans().size(), 2U);
}

TEST(Segmentation, LeavesApartThreeWhoWalkAbreast) {
  const Sweep three([](double angle) -> std::optional<double> {
    const double along_m = 20.0 * angle;
    return std::abs(along_m - std::round(along_m)) < 0.2 && std::abs(along_m) < 1.3
               ? std::optional(20.0)
               : std::nullopt;
  });
  EXPECT_EQ(three.spans().size(), 3U);
}

TEST(Segmentation, KnowsWhatGoesOnFromTheLastBeamToTheFirst) {
  constexpr int kBeams = 720;
  const auto goes_on = [](double range_at_end_m, double step_rad) {
    std::vector<Eigen::Vector2f> points_m(kBeams, Eigen::Vector2f::Zero());
    std::vector<float> range_m(kBeams, 0.0F);
    for (int beam = 0; beam < kBeams; ++beam) {
      if (beam > 10 && beam < kBeams - 10) continue;
      const double angle = -M_PI + beam * step_rad;
      const double range = beam <= 10 ? 10.0 : range_at_end_m;
      range_m[static_cast<std::size_t>(beam)] = static_cast<float>(range);
      points_m[static_cast<std::size_t>(beam)] =
          Eigen::Vector2d(range * std::cos(angle), range * std::sin(angle)).cast<float>();
    }
    std::vector<BeamSpan> spans;
    segment_by_distance(points_m, range_m, step_rad, {}, spans);
    EXPECT_EQ(spans.size(), 2U);
    return continues_across_seam(points_m, range_m, step_rad, {}, spans);
  };
  EXPECT_TRUE(goes_on(10.1, kStepRad));
  EXPECT_FALSE(goes_on(12.0, kStepRad)) << "something else";
  EXPECT_FALSE(goes_on(10.1, 0.5 * kStepRad)) << "half a turn";
}

TEST(Segmentation, FindsNothingInAScanWithoutEchoes) {
  EXPECT_TRUE(Sweep([](double) -> std::optional<double> { return std::nullopt; }).spans().empty());
}

}  // namespace
}  // namespace slammot::sensing
