#include "common/streets/street_localization.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace slammot::streets {
namespace {

using geometry::Pose2;
using geometry::Vector2;

/// Streets of an irregular grid: no two blocks are alike.
StreetGraph irregular_town() {
  const std::vector<double> columns_m{0.0, 90.0, 210.0, 310.0, 450.0};
  const std::vector<double> rows_m{0.0, 120.0, 200.0, 330.0, 420.0};
  StreetGraph graph;
  for (const double x_m : columns_m)
    for (std::size_t i = 1; i < rows_m.size(); ++i)
      graph.streets.push_back({"", {{x_m, rows_m[i - 1]}, {x_m, rows_m[i]}}});
  for (const double y_m : rows_m)
    for (std::size_t i = 1; i < columns_m.size(); ++i)
      graph.streets.push_back({"", {{columns_m[i - 1], y_m}, {columns_m[i], y_m}}});
  return graph;
}

/// Way along corners, 1.75 m to the right of the streets, in streets.
std::vector<Pose2> way_along(const std::vector<Vector2>& corners_m) {
  std::vector<Pose2> way;
  for (std::size_t i = 1; i < corners_m.size(); ++i) {
    const Vector2 along_m = corners_m[i] - corners_m[i - 1];
    const Vector2 unit = along_m.normalized();
    const Vector2 right_m{1.75 * unit.y(), -1.75 * unit.x()};
    for (double at_m = 5.0; at_m < along_m.norm() - 5.0; at_m += 1.0) {
      const Vector2 place_m = corners_m[i - 1] + at_m * unit + right_m;
      way.push_back({place_m.x(), place_m.y(), std::atan2(unit.y(), unit.x())});
    }
  }
  return way;
}

/// The same in a map whose frame lies anywhere.
std::vector<Pose2> in_map(std::vector<Pose2> way, const Pose2& streets_from_map) {
  const Pose2 map_from_streets = geometry::inverse(streets_from_map);
  for (Pose2& pose : way) pose = map_from_streets * pose;
  return way;
}

const Pose2 kStreetsFromMap{35.0, 80.0, 2.0};
const std::vector<Vector2> kCorners_m{{90.0, 20.0},   {90.0, 200.0},  {310.0, 200.0},
                                      {310.0, 330.0}, {450.0, 330.0}, {450.0, 400.0}};

void expect_found(const StreetLocation& location, double within_m = 4.0) {
  ASSERT_EQ(location.verdict, StreetVerdict::kLocated);
  const Pose2& found = location.fits.front().streets_from_map;
  EXPECT_NEAR(found.x_m, kStreetsFromMap.x_m, within_m);
  EXPECT_NEAR(found.y_m, kStreetsFromMap.y_m, within_m);
  EXPECT_NEAR(found.heading_rad, kStreetsFromMap.heading_rad, 0.02);
}

TEST(StreetLocalization, FindsAWayWithTurnsFromARoughStart) {
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  expect_found(locate(irregular_town(), way, StartArea{{150.0, 60.0}, 100.0}));
}

TEST(StreetLocalization, FindsItWithoutAnyStart) {
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  expect_found(locate(irregular_town(), way, std::nullopt));
}

TEST(StreetLocalization, FindsItThoughAStreetOfTheWayIsMissing) {
  StreetGraph graph = irregular_town();
  std::erase_if(graph.streets, [](const Street& street) {
    return street.line_m[0] == Vector2(90.0, 200.0) && street.line_m[1] == Vector2(210.0, 200.0);
  });
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  expect_found(locate(graph, way, StartArea{{150.0, 60.0}, 100.0}));
}

/// Errors of the graph belong to its junctions; the streets between have them in proportion.
TEST(StreetLocalization, FindsItThoughEachJunctionIsOff) {
  StreetGraph graph = irregular_town();
  const auto off_m = [](const Vector2& junction_m) {
    const double phase = 0.7 * junction_m.x() + 1.3 * junction_m.y();
    return Vector2(2.0 * std::sin(phase), 2.0 * std::cos(3.0 * phase));
  };
  for (Street& street : graph.streets)
    for (Vector2& point_m : street.line_m) point_m += off_m(point_m);
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  expect_found(locate(graph, way, StartArea{{150.0, 60.0}, 100.0}));
}

/// Two places fit all streets of the way alike: nothing in its shape tells which is right.
TEST(StreetLocalization, SaysThatAWayThroughARegularTownIsAmbiguous) {
  StreetGraph graph;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 5; ++j) {
      graph.streets.push_back({"", {{100.0 * i, 100.0 * j}, {100.0 * i, 100.0 * (j + 1)}}});
      graph.streets.push_back({"", {{100.0 * j, 100.0 * i}, {100.0 * (j + 1), 100.0 * i}}});
    }
  }
  const auto way =
      way_along({{200.0, 120.0}, {200.0, 200.0}, {300.0, 200.0}, {300.0, 300.0}, {200.0, 300.0}});
  const StreetLocation location = locate(graph, way, StartArea{{210.0, 150.0}, 100.0, 0.0});
  ASSERT_EQ(location.verdict, StreetVerdict::kAmbiguous);
  EXPECT_LT(location.fits[0].probability, 0.6);
}

/// Where a street is missing, another place that fits but for an error of 12 m is not taken for the
/// right one.
TEST(StreetLocalization, DoesNotTakeAnotherBlockForTheOneWhoseStreetIsMissing) {
  const auto town = [](bool is_complete) {
    StreetGraph graph;
    const std::vector<double> columns_m{0.0, 100.0, 212.0, 312.0};
    const std::vector<double> rows_m{0.0, 110.0, 205.0, 330.0};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 1; j < 4; ++j) {
        if (is_complete || i != 1 || j != 2)
          graph.streets.push_back({"", {{columns_m[i], rows_m[j - 1]}, {columns_m[i], rows_m[j]}}});
        graph.streets.push_back({"", {{columns_m[j - 1], rows_m[i]}, {columns_m[j], rows_m[i]}}});
      }
    }
    return graph;
  };
  const auto way = way_along({{10.0, 110.0},
                              {100.0, 110.0},
                              {100.0, 205.0},
                              {212.0, 205.0},
                              {212.0, 330.0},
                              {312.0, 330.0}});
  const StartArea start{{60.0, 110.0}, 100.0, 0.0};
  for (const bool is_complete : {true, false}) {
    const StreetLocation location = locate(town(is_complete), way, start);
    ASSERT_EQ(location.verdict, StreetVerdict::kLocated) << is_complete;
    EXPECT_LT(location.fits[0].streets_from_map.translation_m().norm(), 5.0) << is_complete;
  }
}

/// A raster of the ground: free within 8 m of the streets, walls elsewhere.
SeenSpace seen_of(const StreetGraph& graph) {
  SeenSpace seen{{-60.0, -60.0}, 0.5, 1140, 1080, {}};
  const std::vector<Segment> segments = graph.segments();
  seen.cells.assign(seen.columns * seen.rows, Seen::kOccupied);
  for (std::size_t row = 0; row < seen.rows; ++row) {
    for (std::size_t column = 0; column < seen.columns; ++column) {
      const Vector2 at_m =
          seen.min_m + seen.cell_m * Vector2(static_cast<double>(column), static_cast<double>(row));
      for (const Segment& segment : segments) {
        if ((segment.nearest_to(at_m) - at_m).norm() < 8.0)
          seen.cells[row * seen.columns + column] = Seen::kFree;
      }
    }
  }
  return seen;
}

/// A straight way fits many streets; where others leave it is different on each.
TEST(StreetLocalization, TellsStraightWaysApartByTheirSideStreets) {
  const StreetGraph graph = irregular_town();
  const auto way = way_along({{90.0, 20.0}, {90.0, 400.0}});
  const StartArea start{{100.0, 60.0}, 100.0, 0.0};
  EXPECT_EQ(locate(graph, way, start).verdict, StreetVerdict::kAmbiguous);
  const StreetLocation location = locate(graph, way, start, {}, seen_of(graph));
  ASSERT_EQ(location.verdict, StreetVerdict::kLocated);
  EXPECT_LT(location.fits.front().streets_from_map.translation_m().norm(), 5.0);
}

TEST(StreetLocalization, SearchesAlongTheWayUntilOnePlaceIsClear) {
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  const StreetSearch search =
      search_along(irregular_town(), way, StartArea{{150.0, 60.0}, 100.0}, 1000.0);
  ASSERT_TRUE(search.located_after_m);
  EXPECT_LT(*search.located_after_m, 600.0);
  expect_found(search.location);
}

TEST(StreetLocalization, SaysThatAStraightWayIsAmbiguous) {
  const auto way = in_map(way_along({{90.0, 20.0}, {90.0, 190.0}}), kStreetsFromMap);
  const StreetLocation location = locate(irregular_town(), way, StartArea{{100.0, 60.0}, 100.0});
  EXPECT_EQ(location.verdict, StreetVerdict::kAmbiguous);
  EXPECT_GT(location.fits.size(), 1U);
}

TEST(StreetLocalization, SaysThatAWayBesideAllStreetsIsNotOnThem) {
  std::vector<Pose2> spiral;
  for (int i = 0; i < 400; ++i) {
    const double angle_rad = 0.02 * i;
    const double radius_m = 20.0 + 0.1 * i;
    spiral.push_back({radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad),
                      geometry::wrap_angle(angle_rad + 1.6)});
  }
  const StreetLocation location = locate(irregular_town(), spiral, StartArea{{150.0, 150.0}, 50.0});
  EXPECT_EQ(location.verdict, StreetVerdict::kNotOnStreets);
}

TEST(StreetLocalization, SaysThatAShortWayTellsNothing) {
  const auto way = way_along({{90.0, 20.0}, {90.0, 90.0}});
  EXPECT_EQ(locate(irregular_town(), way, std::nullopt).verdict, StreetVerdict::kTooShort);
}

TEST(StreetLocalization, FindsNothingInAnEmptyGraph) {
  const auto way = way_along(kCorners_m);
  EXPECT_EQ(locate({}, way, std::nullopt).verdict, StreetVerdict::kNotOnStreets);
}

TEST(StreetLocalization, TakesADirectionWithoutAPlace) {
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  StartArea start{.radius_m = kAnywhere_m, .x_from_east_rad = kStreetsFromMap.heading_rad};
  expect_found(locate(irregular_town(), way, start));
  start.x_from_east_rad = kStreetsFromMap.heading_rad + 1.5;
  const StreetLocation elsewhere = locate(irregular_town(), way, start);
  for (const StreetFit& fit : elsewhere.fits)
    EXPECT_GT((fit.streets_from_map.translation_m() - kStreetsFromMap.translation_m()).norm(),
              20.0);
}

TEST(StreetLocalization, IsTheSameWithFarStreetsInTheGraph) {
  const auto way = in_map(way_along(kCorners_m), kStreetsFromMap);
  const StartArea start{.centre_m = {90.0, 20.0}, .radius_m = 100.0};
  StreetGraph country = irregular_town();
  for (int i = 0; i < 50; ++i)
    country.streets.push_back({"", {{5000.0 + 90.0 * i, 0.0}, {5000.0 + 90.0 * i, 4000.0}}});
  const StreetLocation alone = locate(irregular_town(), way, start);
  const StreetLocation beside = locate(country, way, start);
  ASSERT_EQ(beside.fits.size(), alone.fits.size());
  EXPECT_EQ(beside.fits.front().streets_from_map, alone.fits.front().streets_from_map);
  EXPECT_EQ(beside.fits.front().cost, alone.fits.front().cost);
}

}  // namespace
}  // namespace slammot::streets
