#include "services/tracking/speed_evidence.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using geometry::Vector2;
using testing::Street;
using testing::StreetBox;

constexpr double kFastestMps = 25.0;
constexpr std::int64_t kPeriodNs = 100'000'000;
constexpr int kScans = 10;

struct Scene {
  StreetBox box_at_start;  ///< Moves along x.
  std::vector<StreetBox> standing;
  double others_within_m = 0.0;  ///< Echoes that are nearer are known to be others'.
};

constexpr flow::TrackId kOwn{1};
constexpr flow::TrackId kOther{2};

std::vector<Owner> owners_of(const PolarView& view, double others_within_m) {
  std::vector<Owner> owners(view.beam_count());
  for (std::size_t beam = 0; beam < owners.size(); ++beam)
    if (view.range_m(beam) > 0.0 && view.range_m(beam) < others_within_m)
      owners[beam] = {kOther, true, false};
  return owners;
}

/// What scans of the last second say, at its end, of the speed along x of what was hit within the
/// box.
SpeedEvidence evidence_of(const Scene& scene, double speed_mps) {
  ScanHistory history;
  for (int i = 0;; ++i) {
    const std::int64_t stamp_ns = i * kPeriodNs;
    StreetBox box = scene.box_at_start;
    box.odom_from_box.x_m += speed_mps * static_cast<double>(stamp_ns) * 1e-9;
    Street street;
    street.known = scene.standing;
    street.unknown = {box};
    const flow::SegmentedScan scan =
        detection::detect(street.scan(stamp_ns, static_cast<std::uint32_t>(i)), {});
    const PolarView view(scan);
    if (i < kScans) {
      history.add(stamp_ns, view, owners_of(view, scene.others_within_m));
      continue;
    }
    std::vector<Vector2> echoes_m;
    for (std::size_t beam = 0; beam < view.beam_count(); ++beam) {
      const Vector2 in_box_m = geometry::inverse(box.odom_from_box) * view.point_in_odom_m(beam);
      const bool is_hit = view.range_m(beam) > 0.0 &&
                          std::abs(in_box_m.x()) < 0.5 * box.length_m + 0.1 &&
                          std::abs(in_box_m.y()) < 0.5 * box.width_m + 0.1;
      if (is_hit) echoes_m.push_back(view.point_in_odom_m(beam));
    }
    return speed_along({{1.0, 0.0}, echoes_m, stamp_ns, kOwn}, history, kFastestMps);
  }
}

const StreetBox kWallBehind{{60.0, 0.0, M_PI / 2.0}, 160.0, 1.0};

TEST(SpeedEvidence, KnowsTheSpeedOfACarOfWhichItSeesTheFace) {
  for (const double speed_mps : {-8.0, 0.0, 5.0}) {
    const SpeedEvidence evidence = evidence_of({{{20.0, 2.0, 0.0}}, {kWallBehind}}, speed_mps);
    EXPECT_NEAR(evidence.speed_mps, speed_mps, 1.5);
    EXPECT_LT(evidence.sigma_mps, 2.0);
  }
}

TEST(SpeedEvidence, SaysThatItDoesNotKnowHowFastAFlankWithoutEndsSlides) {
  const StreetBox left{{2.0, 4.0, M_PI / 2.0}, 3.0, 1.0};  // between these two the flank is seen
  const StreetBox right{{2.0, -0.8, M_PI / 2.0}, 3.0, 1.0};
  const StreetBox far_wall{{0.0, 40.0, 0.0}, 160.0, 1.0};
  const SpeedEvidence evidence =
      evidence_of({{{20.0, 12.0, 0.0}, 60.0, 2.5}, {kWallBehind, far_wall, left, right}}, 6.0);
  EXPECT_GT(evidence.sigma_mps, 2.0);
}

TEST(SpeedEvidence, DoesNotPreferASpeedAtWhichItWouldHaveBeenSeenWhereAnotherHidIt) {
  const StreetBox left{{2.0, 4.0, M_PI / 2.0}, 3.0, 1.0};
  const StreetBox right{{2.0, -0.8, M_PI / 2.0}, 3.0, 1.0};
  const StreetBox far_wall{{0.0, 40.0, 0.0}, 160.0, 1.0};
  Scene scene{{{20.0, 12.0, 0.0}, 60.0, 2.5}, {kWallBehind, far_wall, left, right}};
  const double unsure_mps = evidence_of(scene, 6.0).sigma_mps;
  scene.others_within_m = 7.0;
  EXPECT_GT(evidence_of(scene, 6.0).sigma_mps, unsure_mps + 0.5);
}

TEST(SpeedEvidence, KnowsNothingWithoutAPast) {
  const std::vector<Vector2> echoes_m = {{10.0, 0.0}, {10.0, 0.1}};
  const SpeedEvidence evidence =
      speed_along({{1.0, 0.0}, echoes_m, kPeriodNs, kOwn}, ScanHistory(), kFastestMps);
  EXPECT_NEAR(evidence.speed_mps, 0.0, 1e-9);
  EXPECT_GT(evidence.sigma_mps, 0.4 * kFastestMps);
}

}  // namespace
}  // namespace slammot::tracking
