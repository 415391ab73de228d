#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace slammot::simulation {

/// Purpose of a sequence of random numbers. Each purpose has its own sequence, so that, for
/// instance, an additional car does not change the scanner's noise.
enum class Purpose : std::uint64_t {
  world = 1,
  traffic,
  pedestrians,
  vehicle,
  odometry,
  scanner,
  route,
  gnss,
  compass,
  imu
};

/// Random numbers that are equal on every platform: std::mt19937_64, whose sequence the C++
/// standard fixes, with distributions implemented here, because those of the standard library
/// differ between implementations.
class Random {
 public:
  Random(std::uint64_t seed, Purpose purpose);

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high);
  /// Standard normal; Box and Muller 1958, both values of a pair are used.
  double normal();
  /// True with this probability.
  bool chance(double probability);
  /// Uniform in 0 .. count-1; count > 0.
  std::size_t index(std::size_t count);

 private:
  std::mt19937_64 engine_;
  double spare_normal_ = 0.0;
  bool has_spare_normal_ = false;
};

}  // namespace slammot::simulation
