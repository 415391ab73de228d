#include "common/association/multiple_hypotheses.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "common/association/gating.hpp"
#include "common/filters/kalman.hpp"

namespace slammot::association {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector4d;
using State = filters::Gaussian<4>;

constexpr double kPeriodS = 0.1;
constexpr double kSigmaM = 0.1;
constexpr double kMissCost = 25.0;

Eigen::Matrix<double, 2, 4> position_of_state() {
  Eigen::Matrix<double, 2, 4> H = Eigen::Matrix<double, 2, 4>::Zero();
  H(0, 0) = H(1, 1) = 1.0;
  return H;
}

State predicted(const State& state) {
  Matrix4d F = Matrix4d::Identity();
  F(0, 2) = F(1, 3) = kPeriodS;
  Matrix4d Q = Matrix4d::Zero();
  Q.diagonal() << 1e-5, 1e-5, 2e-3, 2e-3;
  return filters::kalman_predict<4>(state, F, Q);
}

/// Points measured in one scan; each may be of up to `most_sharers` tracks.
struct PointScan {
  std::vector<Vector2d> positions_m;
  std::size_t most_sharers = 1;

  static Matrix2d noise_m2(std::size_t sharers) {
    constexpr double kMergedSigmaM = 0.3;  // where in what is seen as one each of them is
    const double sigma_m = sharers == 0 ? kSigmaM : kMergedSigmaM;
    return sigma_m * sigma_m * Matrix2d::Identity();
  }
  std::size_t measurement_count() const { return positions_m.size(); }
  std::size_t capacity(std::size_t) const { return most_sharers; }
  double pair_cost(TrackKey, const State& state, std::size_t measurement,
                   std::size_t sharers) const {
    const Matrix2d S = state.covariance.topLeftCorner<2, 2>() + noise_m2(sharers);
    const double distance2 =
        mahalanobis_squared<2>(positions_m[measurement] - state.mean.head<2>(), S);
    return distance2 > planar_gate(0.999) ? kForbidden
                                          : distance2 + std::log(S.determinant() / 1e-6);
  }
  double miss_cost(TrackKey, const State&) const { return kMissCost; }
  State updated(TrackKey, const State& state, std::size_t measurement, std::size_t sharers) const {
    return filters::kalman_update<4, 2>(state, positions_m[measurement], position_of_state(),
                                        noise_m2(sharers))
        .posterior;
  }
  State missed(TrackKey, const State& state) const { return state; }
  bool are_same(const State& a, const State& b) const {
    return mahalanobis_squared<4>(a.mean - b.mean, a.covariance) < 0.1;
  }
};

State start_at(const Vector4d& mean) {
  return {mean, Vector4d(0.01, 0.01, 0.02, 0.02).asDiagonal()};
}

/// With one hypothesis and one child what is ambiguous is decided at once: global nearest
/// neighbour.
constexpr MhtConfig kNearestNeighbour{1, 1, 1, 8, 12.0};
constexpr MhtConfig kManyHypotheses{12, 4, 15, 8, 12.0};

/// Two who cross each other's way at a small angle: at the time zero they are at the same place.
Vector2d crossing(int who, double t) { return {1.2 * t, (who == 0 ? 0.25 : -0.25) * t}; }

Vector4d crossing_state(int who, double t) {
  const Vector2d position_m = crossing(who, t);
  return {position_m.x(), position_m.y(), 1.2, who == 0 ? 0.25 : -0.25};
}

class World {
 public:
  World(const MhtConfig& config, unsigned seed) : tracks(config), random_(seed) {}

  Vector2d noisy(const Vector2d& truth_m) {
    const double x_m = kSigmaM * normal_(random_);
    return truth_m + Vector2d(x_m, kSigmaM * normal_(random_));
  }

  double uniform() { return uniform_(random_); }

  void step(const PointScan& scan) {
    tracks.change_alternatives([](TrackKey, State& state) { state = predicted(state); });
    for (const TrackKey key : tracks.keys()) tracks.set_best(key, predicted(tracks.best(key)));
    tracks.step(scan);
  }

  MultipleHypotheses<State> tracks;

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

struct Seen {
  double merged_below_m = 0.0;   ///< Nearer than this they are one measurement,
  std::size_t most_sharers = 1;  ///< which may be held for so many.
  double missed_share = 0.0;
  int clutter = 0;  ///< False measurements a scan, within a few metres.
};

/// Whether two who cross have changed their names afterwards, or one is lost.
bool swaps(const MhtConfig& config, unsigned seed, const Seen& seen) {
  World world(config, seed);
  const double begin_s = -3.0;
  for (int who : {0, 1})
    world.tracks.add(static_cast<TrackKey>(who), start_at(crossing_state(who, begin_s)));
  constexpr int kScans = 60;
  for (int scan = 1; scan <= kScans; ++scan) {
    const double t = begin_s + scan * kPeriodS;
    PointScan points{{}, seen.most_sharers};
    if ((crossing(0, t) - crossing(1, t)).norm() < seen.merged_below_m) {
      points.positions_m = {world.noisy(0.5 * (crossing(0, t) + crossing(1, t)))};
    } else {
      for (const int who : {scan % 2, 1 - scan % 2})
        if (world.uniform() >= seen.missed_share)
          points.positions_m.push_back(world.noisy(crossing(who, t)));
    }
    for (int i = 0; i < seen.clutter; ++i)
      points.positions_m.emplace_back(
          crossing(0, t) + Vector2d(4.0 * world.uniform() - 2.0, 4.0 * world.uniform() - 2.0));
    world.step(points);
  }
  const auto off_m = [&](TrackKey key, int who) {
    return (world.tracks.best(key).mean.head<2>() - crossing(who, 3.0)).norm();
  };
  constexpr double kNearM = 0.5;
  return off_m(0, 0) > kNearM || off_m(1, 1) > kNearM;
}

int swaps_of(const MhtConfig& config, const Seen& seen) {
  int count = 0;
  for (unsigned seed = 0; seed < 100; ++seed) count += swaps(config, seed, seen) ? 1 : 0;
  return count;
}

TEST(MultipleHypotheses, KeepNamesWhereTheNearestNeighbourSwapsThem) {
  EXPECT_GE(swaps_of(kNearestNeighbour, {}), 10);
  EXPECT_LE(swaps_of(kManyHypotheses, {}), 1);
}

TEST(MultipleHypotheses, KeepNamesWhileTwoAreSeenAsOne) {
  EXPECT_GE(swaps_of(kNearestNeighbour, {.merged_below_m = 0.2}), 8);
  EXPECT_LE(swaps_of(kManyHypotheses, {.merged_below_m = 0.2, .most_sharers = 2}), 1);
}

TEST(MultipleHypotheses, KeepNamesAmongFalseMeasurements) {
  EXPECT_GE(swaps_of(kNearestNeighbour, {.clutter = 8}), 10);
  EXPECT_LE(swaps_of(kManyHypotheses, {.clutter = 8}), 2);
}

TEST(MultipleHypotheses, KeepNamesThoughMeasurementsAreMissing) {
  EXPECT_GE(swaps_of(kNearestNeighbour, {.missed_share = 0.1}), 4);
  EXPECT_LE(swaps_of(kManyHypotheses, {.missed_share = 0.1}), 1);
}

TEST(MultipleHypotheses, AreTheBestAssignmentWhereOnlyOneIsKept) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-0.6, 0.6);
  for (int trial = 0; trial < 50; ++trial) {
    MultipleHypotheses<State> tracks(kNearestNeighbour);
    CostMatrix costs(5, 4, 0.0);
    PointScan scan;
    for (std::size_t j = 0; j < costs.columns; ++j)
      scan.positions_m.emplace_back(uniform(random), uniform(random));
    for (std::size_t i = 0; i < costs.rows; ++i) {
      const State state = start_at({uniform(random), uniform(random), 0.0, 0.0});
      tracks.add(static_cast<TrackKey>(i), state);
      for (std::size_t j = 0; j < costs.columns; ++j) costs(i, j) = scan.pair_cost(0, state, j, 0);
    }
    tracks.step(scan);
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < costs.rows; ++i)
      chosen.push_back(tracks.measurement_of(static_cast<TrackKey>(i)));
    EXPECT_EQ(chosen, assign(costs, kMissCost));
  }
}

TEST(MultipleHypotheses, AreOneWhereNothingIsAmbiguous) {
  World world(kManyHypotheses, 1);
  for (int who : {0, 1, 2})
    world.tracks.add(static_cast<TrackKey>(who), start_at({0.0, 10.0 * who, 0.0, 0.0}));
  for (int scan = 0; scan < 30; ++scan) {
    world.step({{world.noisy({0.0, 20.0}), world.noisy({0.0, 0.0})}, 1});
    EXPECT_EQ(world.tracks.measurement_of(0), 1U);
    EXPECT_EQ(world.tracks.measurement_of(1), kUnassigned);
    EXPECT_EQ(world.tracks.measurement_of(2), 0U);
    for (const TrackKey key : {0U, 1U, 2U}) EXPECT_EQ(world.tracks.hypothesis_count(key), 1U);
  }
}

TEST(MultipleHypotheses, AreDecidedSoonAfterTheAmbiguityIsOver) {
  World world(kManyHypotheses, 2);
  for (int who : {0, 1})
    world.tracks.add(static_cast<TrackKey>(who), start_at(crossing_state(who, -0.3)));
  std::size_t most = 1;
  double ambiguous_until_s = 0.0;
  for (int scan = 1; scan <= 60; ++scan) {
    const double t = -0.3 + scan * kPeriodS;
    world.step({{world.noisy(crossing(0, t)), world.noisy(crossing(1, t))}, 1});
    const std::size_t count = world.tracks.hypothesis_count(0);
    most = std::max(most, count);
    if (count > 1) ambiguous_until_s = t;
  }
  EXPECT_GT(most, 3U);
  EXPECT_LT(ambiguous_until_s, 4.0);  // their ways are 2 m apart then
}

TEST(MultipleHypotheses, AreBoundedWhateverTheClutter) {
  World world(kManyHypotheses, 3);
  constexpr TrackKey kTracks = 40;
  for (TrackKey key = 0; key < kTracks; ++key)
    world.tracks.add(key, start_at({2.0 * world.uniform(), 8.0 * world.uniform(), 0.0, 0.0}));
  for (int scan = 0; scan < 8; ++scan) {
    PointScan points{{}, 2};
    for (int i = 0; i < 50; ++i)
      points.positions_m.emplace_back(2.0 * world.uniform(), 8.0 * world.uniform());
    world.step(points);
    for (TrackKey key = 0; key < kTracks; ++key)
      EXPECT_LE(world.tracks.hypothesis_count(key), kManyHypotheses.most_hypotheses);
  }
  EXPECT_EQ(world.tracks.keys().size(), kTracks);
}

/// The children of the best hypothesis alone must not fill a cluster: a rival may be the truth.
TEST(MultipleHypotheses, KeepARivalWhileFalseMeasurementsSurroundTheBest) {
  World world(MhtConfig{}, 5);
  world.tracks.add(0, start_at({0.0, 0.0, 0.0, 0.0}));
  const Vector2d truth_m{0.45, 0.0};
  world.step({{{-0.25, 0.0}, {0.3, 0.0}}, 1});
  ASSERT_EQ(world.tracks.measurement_of(0), 0U);
  PointScan clutter{{truth_m}, 1};
  for (int i = 0; i < 7; ++i) clutter.positions_m.emplace_back(-0.28, 0.04 * (i - 3));
  world.step(clutter);
  ASSERT_NE(world.tracks.measurement_of(0), 0U);
  for (int scan = 0; scan < 3; ++scan) world.step({{truth_m}, 1});
  EXPECT_EQ(world.tracks.measurement_of(0), 0U);
  EXPECT_NEAR(world.tracks.best(0).mean.x(), truth_m.x(), 0.1);
}

TEST(MultipleHypotheses, ForgetWhoIsRemovedAndGoOnWithTheOthers) {
  World world(kManyHypotheses, 4);
  for (int who : {0, 1})
    world.tracks.add(static_cast<TrackKey>(who), start_at(crossing_state(who, -0.3)));
  for (int scan = 1; scan <= 4; ++scan) {
    const double t = -0.3 + scan * kPeriodS;
    world.step({{world.noisy(crossing(0, t)), world.noisy(crossing(1, t))}, 1});
  }
  ASSERT_GT(world.tracks.hypothesis_count(1), 1U);
  const Vector4d before = world.tracks.best(1).mean;
  world.tracks.remove(0);
  EXPECT_FALSE(world.tracks.has(0));
  EXPECT_EQ(world.tracks.best(1).mean, before);
  world.tracks.remove(0);  // nothing more to forget
  world.tracks.remove(1);
  EXPECT_TRUE(world.tracks.keys().empty());
}

}  // namespace
}  // namespace slammot::association
