#include "services/localization/recent_odometry.hpp"

#include <gtest/gtest.h>

namespace slammot::localization {
namespace {

std::vector<std::int64_t> stamps_of_newest_drive(const std::vector<std::int64_t>& stamps_ns) {
  RecentOdometry recent;
  for (const std::int64_t stamp_ns : stamps_ns) recent.add({stamp_ns, {}});
  std::vector<std::int64_t> newest;
  for (const sensing::Odometry& odometry : recent.of_newest_drive())
    newest.push_back(odometry.stamp_ns);
  return newest;
}

TEST(RecentOdometry, OfANewDriveIsThatSinceStampsWentBack) {
  using Stamps = std::vector<std::int64_t>;
  EXPECT_EQ(stamps_of_newest_drive({}), Stamps());
  EXPECT_EQ(stamps_of_newest_drive({5, 6, 7}), (Stamps{5, 6, 7}));
  EXPECT_EQ(stamps_of_newest_drive({5, 6, 1, 2, 3}), (Stamps{1, 2, 3}));
  EXPECT_EQ(stamps_of_newest_drive({5, 1, 6, 2}), (Stamps{2}));
  EXPECT_EQ(stamps_of_newest_drive({5, 5, 6}), (Stamps{5, 5, 6}));
}

TEST(RecentOdometry, IsForgottenAfterSomeHundreds) {
  RecentOdometry recent;
  for (std::int64_t stamp_ns = 0; stamp_ns < 1000; ++stamp_ns) recent.add({stamp_ns, {}});
  const std::vector<sensing::Odometry> newest = recent.of_newest_drive();
  EXPECT_EQ(newest.size(), 300U);
  EXPECT_EQ(newest.back().stamp_ns, 999);
}

}  // namespace
}  // namespace slammot::localization
