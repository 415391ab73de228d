#include "common/simulation/random.hpp"

#include <cmath>
#include <numbers>

namespace slammot::simulation {
namespace {

/// Finaliser of SplitMix64 (Steele et al. 2014): neighbouring seeds and purposes start far apart.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, Purpose purpose)
    : engine_(mixed(mixed(seed) ^ static_cast<std::uint64_t>(purpose))) {}

double Random::uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::uniform(double low, double high) { return low + (high - low) * uniform(); }

double Random::normal() {
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));  // 1 - u is never 0
  const double angle_rad = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle_rad);
  has_spare_normal_ = true;
  return radius * std::cos(angle_rad);
}

bool Random::chance(double probability) { return uniform() < probability; }

std::size_t Random::index(std::size_t count) {
  return static_cast<std::size_t>(uniform() * static_cast<double>(count));
}

}  // namespace slammot::simulation
