#include "services/localization/submap_cells.hpp"

#include <gtest/gtest.h>

#include "common/grids/lasting_evidence.hpp"

namespace slammot::localization {
namespace {

grids::GridWindow window_of(std::int32_t columns, std::int32_t rows) {
  grids::GridWindow window;
  window.cell_size_m = 0.2;
  window.first = {-10, 20};
  window.columns = columns;
  window.rows = rows;
  return window;
}

TEST(SubmapCells, AreBoundedByWhatWasSeenSince) {
  const grids::GridWindow window = window_of(4, 3);
  const std::vector<std::int8_t> so_before(12, 3);
  const std::vector<std::uint8_t> mo_before(12, 0);
  std::vector<std::int8_t> so = so_before;
  std::vector<std::uint8_t> mo = mo_before;
  so[1 * 4 + 1] = 2;
  mo[2 * 4 + 3] = 1;
  const grids::GridWindow bounds = bounds_of_seen(window, {so, mo}, {so_before, mo_before});
  EXPECT_EQ(bounds.first.column, -9);
  EXPECT_EQ(bounds.first.row, 21);
  EXPECT_EQ(bounds.columns, 3);
  EXPECT_EQ(bounds.rows, 2);
}

TEST(SubmapCells, AreNoneWhereNothingWasSeen) {
  const std::vector<std::int8_t> so(12, 3);
  std::vector<std::uint8_t> mo(12, 7);
  const std::vector<std::uint8_t> mo_before = mo;
  mo[5] = 6;  // motion that is forgotten is not seen
  EXPECT_EQ(bounds_of_seen(window_of(4, 3), {so, mo}, {so, mo_before}).cell_count(), 0U);
}

TEST(SubmapCells, HoldTheChangeOfTheEvidenceWithinTheRangeOfAByte) {
  const std::int8_t so[] = {5, -5, 100, -100};
  const std::int8_t so_before[] = {3, 3, -100, 100};
  std::int8_t own_so[4];
  put_own_so(so, so_before, 4, own_so);
  EXPECT_EQ(std::vector<int>(own_so, own_so + 4), (std::vector{2, -8, 127, -127}));
  const std::uint8_t mo[] = {9, 4, 4};
  const std::uint8_t mo_before[] = {4, 4, 9};
  std::uint8_t own_mo[3];
  put_own_mo(mo, mo_before, 3, own_mo);
  EXPECT_EQ(std::vector<int>(own_mo, own_mo + 3), (std::vector{9, 0, 0}));
}

TEST(SubmapCells, OfTheNextSubmapAreThoseThatChangedShortOfTheLimit) {
  std::int8_t now[] = {5, 5, 40, -40};
  const std::int8_t before[] = {5, 4, 0, 0};
  keep_changed(now, before, 4, 30);
  EXPECT_EQ(std::vector<int>(now, now + 4), (std::vector{0, 5, 30, -30}));
}

TEST(SubmapCells, OfLastingEvidenceStayDrivenOver) {
  constexpr std::int8_t kDrivenOver = -127;
  ASSERT_TRUE(grids::LastingEvidence::is_driven_over(kDrivenOver));
  std::int8_t now[] = {kDrivenOver, 5};
  const std::int8_t before[] = {kDrivenOver, 5};
  keep_changed_or_driven_over(now, before, 2, 30);
  EXPECT_EQ(now[0], kDrivenOver);
  EXPECT_EQ(now[1], 0);
}

}  // namespace
}  // namespace slammot::localization
