#include "common/sensing/turning_direction.hpp"

#include <gtest/gtest.h>

namespace slammot::sensing {
namespace {

TEST(TurningDirection, IsTheUnitVectorOfEachAngle) {
  for (const double step_rad : {0.0087, -0.0044, 0.0, 1.3}) {
    TurningDirection direction(-1.57, step_rad);
    for (int i = 0; i < 2000; ++i, direction.advance()) {
      const double angle_rad = -1.57 + i * step_rad;
      ASSERT_NEAR(
          (direction.now() - geometry::Vector2(std::cos(angle_rad), std::sin(angle_rad))).norm(),
          0.0, 1e-11);
    }
  }
}

}  // namespace
}  // namespace slammot::sensing
