#include "common/files/odometry_agreement.hpp"

#include <gtest/gtest.h>

namespace slammot::files {
namespace {

/// Lines along x, a metre each, with poses of laser records between them that lie so far aside.
OdometryAgreement agreement_at(double aside_m) {
  OdometryAgreement agreement;
  for (int i = 0; i < 10; ++i) {
    agreement.add_odom({10 * i, {1.0 * i, 0.0, 0.0}});
    agreement.add_laser({10 * i + 5, {1.0 * i + 0.5, aside_m, 0.0}});
  }
  return agreement;
}

TEST(OdometryAgreement, AllowsForTheMotionBetweenTwoLines) {
  EXPECT_TRUE(agreement_at(0.0).agrees());
  EXPECT_TRUE(agreement_at(0.55).agrees());
}

TEST(OdometryAgreement, SeesOtherPoses) { EXPECT_FALSE(agreement_at(0.65).agrees()); }

TEST(OdometryAgreement, NeedsPosesBetweenLines) {
  OdometryAgreement agreement;
  agreement.add_laser({5, {}});
  agreement.add_odom({10, {}});
  EXPECT_FALSE(agreement.agrees());
}

}  // namespace
}  // namespace slammot::files
