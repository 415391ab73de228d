"""The measure of trajectories is itself measured."""

import math
import unittest

from trajectory import aligned_rmse_m

DRIVE = [(0.1 * i, math.cos(0.05 * i) * 10.0, 0.3 * i) for i in range(200)]


def moved(rows, angle, dx, dy):
    c, s = math.cos(angle), math.sin(angle)
    return [(t, c * x - s * y + dx, s * x + c * y + dy) for t, x, y in rows]


class AlignedRmse(unittest.TestCase):
    def test_does_not_see_a_rigid_motion(self):
        self.assertAlmostEqual(0.0, aligned_rmse_m(moved(DRIVE, 2.0, 5.0, -7.0), DRIVE), places=9)

    def test_is_the_distance_of_alternating_errors(self):
        shaken = [(t, x + (0.2 if i % 2 else -0.2), y) for i, (t, x, y) in enumerate(DRIVE)]
        self.assertAlmostEqual(0.2, aligned_rmse_m(shaken, DRIVE), places=3)

    def test_needs_stamps_in_common(self):
        with self.assertRaises(ValueError):
            aligned_rmse_m([(99.0, 0.0, 0.0)], DRIVE)


if __name__ == "__main__":
    unittest.main()
