#include "common/sensing/own_body.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/order_statistics.hpp"

namespace slammot::sensing {
namespace {

constexpr std::size_t kFewestViews = 30;
constexpr float kChange = 0.05F;         // of a reading, between two views
constexpr double kChangedShare = 0.4;    // of the beams with an echo in both
constexpr double kFarthestPart_m = 3.0;  // no vehicle sees itself farther away
constexpr double kTolerance_m = 0.03;    // of a rigid part,
constexpr double kTolerance = 0.02;      // and of its distance
constexpr double kConstantShare = 0.9;   // of the views: the rest are failed readings

bool is_reading(float reading) { return reading > 0.0F && std::isfinite(reading); }

/// The reading that most views have, and their share.
struct Usual {
  double reading = 0.0;
  double share = 0.0;
};

double tolerance_of(double reading, double unit_m) {
  return std::max(kTolerance_m / unit_m, kTolerance * reading);
}

Usual usual_of(std::vector<float>& readings, std::size_t views, double unit_m) {
  if (readings.empty()) return {};
  const double reading = static_cast<double>(geometry::upper_median_in_place(readings));
  const auto near = std::ranges::count_if(readings, [&](float one) {
    return std::abs(static_cast<double>(one) - reading) <= tolerance_of(reading, unit_m);
  });
  return {reading, static_cast<double>(near) / static_cast<double>(views)};
}

}  // namespace

std::size_t OwnBody::beams() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(reach, [](float reading) { return reading > 0.0F; }));
}

void OwnBody::hide(std::span<float> readings, float nothing) const {
  if (readings.size() != reach.size()) return;
  for (std::size_t beam = 0; beam < readings.size(); ++beam)
    if (is_reading(readings[beam]) && readings[beam] <= reach[beam]) readings[beam] = nothing;
}

bool OwnBodySurvey::is_another_view(std::span<const float> readings) const {
  std::size_t compared = 0;
  std::size_t changed = 0;
  for (std::size_t beam = 0; beam < readings.size(); ++beam) {
    const float before = last_view_[beam];
    if (!is_reading(readings[beam]) || !is_reading(before)) continue;
    ++compared;
    changed += std::abs(readings[beam] - before) > kChange * before ? 1 : 0;
  }
  return compared == 0 ||
         static_cast<double>(changed) > kChangedShare * static_cast<double>(compared);
}

bool OwnBodySurvey::add(std::span<const float> readings) {
  if (!last_view_.empty() && (readings.size() != last_view_.size() || !is_another_view(readings)))
    return false;
  last_view_.assign(readings.begin(), readings.end());
  views_.add(last_view_);
  return true;
}

OwnBody OwnBodySurvey::conclude(double unit_m) const {
  const std::vector<std::vector<float>>& views = views_.kept();
  if (views.size() < kFewestViews) return {};
  const std::size_t beams = last_view_.size();
  std::vector<float> readings;
  OwnBody body{std::vector<float>(beams, 0.0F)};
  for (std::size_t beam = 0; beam < beams; ++beam) {
    readings.clear();
    for (const std::vector<float>& view : views)
      if (is_reading(view[beam])) readings.push_back(view[beam]);
    const auto [reading, share] = usual_of(readings, views.size(), unit_m);
    if (share < kConstantShare || reading * unit_m > kFarthestPart_m) continue;
    body.reach[beam] = static_cast<float>(reading + tolerance_of(reading, unit_m));
  }
  if (body.beams() == 0) return {};
  // A beam beside it meets its edge now and then.
  const std::vector<float> sure = body.reach;
  for (std::size_t beam = 0; beam < beams; ++beam) {
    const float beside =
        std::max(beam > 0 ? sure[beam - 1] : 0.0F, beam + 1 < beams ? sure[beam + 1] : 0.0F);
    body.reach[beam] = std::max(body.reach[beam], beside);
  }
  return body;
}

}  // namespace slammot::sensing
