#include "services/tracking/motion_evidence.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "services/detection/detector.hpp"
#include "tests/support/street.hpp"

namespace slammot::tracking {
namespace {

using testing::Street;
using testing::StreetBox;

constexpr std::int64_t kPeriodNs = 100'000'000;

/// A car before a wall at this place now, and at the other in the two seconds before.
class Scene {
 public:
  Scene(const StreetBox& now, const StreetBox& before) {
    Street street{{{{40.0, 0.0, M_PI / 2.0}, 120.0, 1.0}}, {before}, {}};
    for (std::int64_t i = 0; i < 20; ++i) {
      const PolarView view(
          detection::detect(street.scan(i * kPeriodNs, static_cast<std::uint32_t>(i)), {}));
      history_.add(i * kPeriodNs, view, std::vector<Owner>(view.beam_count()));
    }
    street.unknown = {now};
    scan_ = detection::detect(street.scan(20 * kPeriodNs, 20), {});
    view_.look_at(scan_);
    comparison_.begin(context());
    for (std::size_t s = 0; s < scan_.segments.size(); ++s) comparison_.compare(s, context());
    for (const flow::Segment& segment : scan_.segments)
      if (segment.label == flow::PointLabel::kMoving)
        beams.insert(beams.end(), segment.beams.begin(), segment.beams.end());
  }

  ComparedScan context() const { return {{view_, history_, config_}, comparison_}; }

  std::vector<std::uint16_t> beams;  ///< Of the car.

 private:
  flow::SegmentedScan scan_;
  ScanView view_;
  ScanHistory history_;
  ScanComparison comparison_;
  TrackingConfig config_;
};

const StreetBox kHere{{20.0, 3.0, M_PI / 2.0}};
const StreetBox kThere{{20.0, -8.0, M_PI / 2.0}};

TEST(MotionEvidence, IsOfMotionWhereEarlierScansSawThroughThePlace) {
  const Scene scene(kHere, kThere);
  ASSERT_GE(scene.beams.size(), 5U);
  for (const bool is_confirmed : {false, true}) {
    Track track;
    track.existence.confirmed = is_confirmed;
    const MotionEvidence evidence = motion_evidence(track, scene.beams, scene.context());
    EXPECT_EQ(evidence.moved, static_cast<double>(scene.beams.size()));
    EXPECT_EQ(evidence.stood, 0.0);
  }
}

TEST(MotionEvidence, IsAgainstItWhereEarlierScansHadEchoesAtThePlace) {
  const Scene scene(kHere, kHere);
  for (const bool is_confirmed : {false, true}) {
    Track track;
    track.existence.confirmed = is_confirmed;
    const MotionEvidence evidence = motion_evidence(track, scene.beams, scene.context());
    EXPECT_EQ(evidence.moved, 0.0);
    EXPECT_GE(evidence.stood, 0.9 * static_cast<double>(scene.beams.size()));
  }
}

TEST(MotionEvidence, OfAFlankThatMaySlideAlongItselfCountsLess) {
  const Scene scene(kHere, kHere);
  Track blob;
  Track car;
  car.extent.outline = Box();
  car.extent.footprint().heading_rad = M_PI / 2.0;
  EXPECT_LT(motion_evidence(car, scene.beams, scene.context()).stood,
            0.5 * motion_evidence(blob, scene.beams, scene.context()).stood);
  car.kinematics.estimate.mean(3) = 6.0;  // a fast flank leaves its place
  EXPECT_EQ(motion_evidence(car, scene.beams, scene.context()).stood,
            motion_evidence(blob, scene.beams, scene.context()).stood);
}

TEST(TentativeEvidence, SumsUpWhatTheMapAndEarlierScansSay) {
  const Scene moved(kHere, kThere);
  TentativeEvidence evidence = with_echoes({}, moved.beams, moved.context());
  evidence = with_echoes(evidence, moved.beams, moved.context());
  EXPECT_EQ(evidence.seen, 2.0 * static_cast<double>(moved.beams.size()));
  EXPECT_GE(evidence.in_free_space, 0.9 * evidence.seen);
  EXPECT_EQ(evidence.stood, 0.0);
  const Scene stood(kHere, kHere);
  EXPECT_GT(with_echoes({}, stood.beams, stood.context()).stood, 0.0);
}

}  // namespace
}  // namespace slammot::tracking
