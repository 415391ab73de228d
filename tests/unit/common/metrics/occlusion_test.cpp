#include "common/metrics/occlusion.hpp"

#include <gtest/gtest.h>

#include "tests/unit/common/metrics/scenes.hpp"

namespace slammot::metrics {
namespace {

constexpr int kScansPerSecond = 10;
const CountingRule kRule;

/// Position of the car at scan i: it drives along the vehicle at 5 m/s.
double x_m(int scan) { return -20.0 + 5.0 * scan / kScansPerSecond; }

/// What is reported of the car in a scan.
struct Report {
  std::size_t track = 0;
  bool is_occluded = false;
  double behind_m = 0.0;
};

struct CarDrive {
  int scans = 80;
  int hidden_from = 20;  ///< First scan without an echo,
  int seen_from = 40;    ///< and the first one with echoes again.
};

/// A drive past one car; `report` gives its track in each scan.
template <typename ReportOf>
std::vector<Scene> scenes_of(const CarDrive& drive, const ReportOf& report) {
  std::vector<Scene> scenes;
  for (int i = 0; i < drive.scans; ++i) {
    Scene scene{i * 1'000'000'000LL / kScansPerSecond, {}, {}, {}};
    TrueObject car = car_at(x_m(i), 5.0);
    const bool is_hidden = i >= drive.hidden_from && i < drive.seen_from;
    if (is_hidden) car.points = 0;
    (is_hidden ? scene.hidden_objects : scene.objects).push_back(car);
    if (const std::optional<Report> row = report(i)) {
      ReportedTrack track = track_at(x_m(i) - row->behind_m, 5.0, row->track);
      track.position_covariance_m2 = geometry::Matrix2::Identity();
      (row->is_occluded ? scene.occluded_tracks : scene.tracks).push_back(track);
    }
    scenes.push_back(scene);
  }
  return scenes;
}

OcclusionFigures figures_of(const std::vector<Scene>& scenes) {
  return occlusion_figures(scenes, kRule);
}

bool is_hidden(int scan) { return scan >= 20 && scan < 40; }

TEST(OcclusionFigures, CountAnIdentityThatIsKeptByTheLengthOfTheOcclusion) {
  const auto figures = figures_of(
      scenes_of({}, [](int i) { return is_hidden(i) ? std::nullopt : std::optional(Report{3}); }));
  EXPECT_EQ(figures.by_length[1].occlusions, 1U);  // 2 s
  EXPECT_EQ(figures.by_length[1].kept, 1U);
  EXPECT_EQ(figures.by_length[1].hidden_rows, 20U);
  EXPECT_EQ(figures.by_length[1].covered_rows, 0U);
  for (const std::size_t other : {0U, 2U, 3U}) EXPECT_EQ(figures.by_length[other].occlusions, 0U);
}

TEST(OcclusionFigures, CountAnotherTrackAfterTheOcclusionAsALostIdentity) {
  const auto figures = figures_of(scenes_of({}, [](int i) {
    return is_hidden(i) ? std::nullopt : std::optional(Report{i < 40 ? 3U : 4U});
  }));
  EXPECT_EQ(figures.by_length[1].occlusions, 1U);
  EXPECT_EQ(figures.by_length[1].kept, 0U);
}

TEST(OcclusionFigures, CountAnObjectThatNoTrackFindsAgainAsALostIdentity) {
  const auto figures = figures_of(
      scenes_of({}, [](int i) { return i < 20 ? std::optional(Report{3}) : std::nullopt; }));
  EXPECT_EQ(figures.by_length[1].occlusions, 1U);
  EXPECT_EQ(figures.by_length[1].kept, 0U);
}

TEST(OcclusionFigures, LeaveOutAnObjectThatWasNotTrackedBefore) {
  const auto figures = figures_of(
      scenes_of({}, [](int i) { return i >= 40 ? std::optional(Report{3}) : std::nullopt; }));
  EXPECT_EQ(figures.by_length[1].occlusions, 0U);
}

TEST(OcclusionFigures, JoinOcclusionsBetweenWhichNoTrackHasTimeToFindTheObject) {
  auto scenes =
      scenes_of({}, [](int i) { return is_hidden(i) ? std::nullopt : std::optional(Report{3}); });
  scenes[25].objects = {car_at(x_m(25), 5.0)};
  scenes[25].hidden_objects.clear();
  const auto figures = figures_of(scenes);
  EXPECT_EQ(figures.by_length[0].occlusions, 0U);
  EXPECT_EQ(figures.by_length[1].occlusions, 1U);
  EXPECT_EQ(figures.by_length[1].kept, 1U);
  EXPECT_EQ(figures.by_length[1].hidden_rows, 19U);
}

TEST(OcclusionFigures, MeasureTheLengthBetweenEchoesEvenIfTheseAreFew) {
  auto scenes = scenes_of({80, 20, 31}, [](int i) {
    return i < 31 && i >= 20 ? std::nullopt : std::optional(Report{3});
  });
  EXPECT_EQ(figures_of(scenes).by_length[1].occlusions, 1U);  // 1.1 s
  for (const std::size_t glimpse : {20U, 30U}) {
    scenes[glimpse].objects = std::move(scenes[glimpse].hidden_objects);
    scenes[glimpse].objects.front().points = 1;
    scenes[glimpse].hidden_objects.clear();
  }
  EXPECT_EQ(figures_of(scenes).by_length[0].occlusions, 1U);  // 0.9 s
}

TEST(OcclusionFigures, MeasureTheOwnTrackWhileTheObjectIsHidden) {
  const auto figures = figures_of(scenes_of({}, [](int i) {
    return Report{3, is_hidden(i), is_hidden(i) ? 2.0 : 0.0};
  }));
  EXPECT_EQ(figures.by_length[1].covered_rows, 20U);
  EXPECT_NEAR(figures.position_m.rmse, 2.0, 1e-9);
  EXPECT_EQ(figures.position_m.count, 20U);
  EXPECT_EQ(figures.position_nees.samples, 2U);  // 0.5 s and 1.5 s after the last sighting
  EXPECT_NEAR(figures.position_nees.mean, 4.0, 1e-9);
  EXPECT_EQ(figures.inside_share, 1.0);
}

TEST(OcclusionFigures, IncludeAFarPredictionInTheErrorButNotInTheCoverage) {
  const auto figures = figures_of(scenes_of({}, [](int i) {
    return Report{3, is_hidden(i), is_hidden(i) ? 9.0 : 0.0};
  }));
  EXPECT_EQ(figures.by_length[1].covered_rows, 0U);
  EXPECT_NEAR(figures.position_m.rmse, 9.0, 1e-9);
  EXPECT_EQ(figures.published.occluded.at_nothing, 20U);
}

TEST(OcclusionFigures, LeaveOutATrackThatFollowsAnotherObjectWithinTheGate) {
  const auto figures_with_another = [](bool is_occluded) {
    auto scenes = scenes_of({}, [is_occluded](int i) {
      return Report{3, is_occluded && is_hidden(i), is_hidden(i) ? 1.5 : 0.0};
    });
    for (int i = 20; i < 40; ++i) {
      TrueObject other = car_at(x_m(i) - 1.4, 5.0);
      other.object = 7;
      scenes[static_cast<std::size_t>(i)].objects.push_back(other);
    }
    return figures_of(scenes);
  };
  EXPECT_EQ(figures_with_another(false).position_m.count, 0U);  // an error of identity
  EXPECT_EQ(figures_with_another(true).position_m.count, 20U);
}

TEST(OcclusionFigures, MeasureAnObjectThatDoesNotReturn) {
  CarDrive drive;
  drive.seen_from = drive.scans;
  const auto figures = figures_of(scenes_of(drive, [](int i) {
    return Report{3, i >= 20, i >= 20 ? 1.0 : 0.0};
  }));
  EXPECT_EQ(figures.position_m.count, 60U);
  for (const OcclusionBand& band : figures.by_length) EXPECT_EQ(band.occlusions, 0U);
}

TEST(OcclusionFigures, TellRowsAtTheOwnObjectFromThoseAtAnother) {
  auto scenes = scenes_of({}, [](int i) { return Report{3, is_hidden(i)}; });
  for (Scene& scene : scenes) {
    for (TrueObject& car : scene.hidden_objects) car.object = 1;  // another one stands there
  }
  const auto figures = figures_of(scenes);
  EXPECT_EQ(figures.published.occluded.at_own_object, 0U);
  EXPECT_EQ(figures.published.occluded.at_other_object, 20U);
  EXPECT_EQ(figures_of(scenes_of({},
                                 [](int i) {
                                   return Report{3, is_hidden(i)};
                                 }))
                .published.occluded.at_own_object,
            20U);
}

TEST(OcclusionFigures, UseInterpolatedRowsWhereTheTruthHasNone) {
  auto scenes = scenes_of({}, [](int i) { return Report{3, is_hidden(i)}; });
  for (Scene& scene : scenes) scene.hidden_objects.clear();
  const auto figures = figures_of(fill_gaps(scenes, 5'000'000'000));
  EXPECT_EQ(figures.by_length[1].hidden_rows, 20U);
  EXPECT_EQ(figures.by_length[1].covered_rows, 20U);
}

TEST(OcclusionFigures, CountGapsOfTracksAndWhetherTheirObjectsWereInView) {
  const auto report = [](int i) {
    const bool is_missing = (i >= 10 && i < 13) || is_hidden(i);
    return is_missing ? std::nullopt : std::optional(Report{3});
  };
  const auto figures = figures_of(scenes_of({}, report));
  EXPECT_EQ(figures.published.gaps.gaps, 2U);
  EXPECT_EQ(figures.published.gaps.gaps_on_object, 2U);
  EXPECT_EQ(figures.published.gaps.missing_rows, 23U);
  EXPECT_EQ(figures.published.gaps.gaps_in_view, 1U);
  EXPECT_EQ(figures.published.gaps.missing_rows_in_view, 3U);
}

TEST(CountScene, DoesNotMatchATrackReportedAsOccluded) {
  Scene scene{0, {}, {car_at(10.0, 0.0)}, {}};
  scene.occluded_tracks = {track_at(10.0, 0.0)};
  const CountedScene counted = count_scene(scene, kRule);
  EXPECT_EQ(counted.objects.size(), 1U);
  EXPECT_TRUE(counted.tracks.empty());
}

}  // namespace
}  // namespace slammot::metrics
