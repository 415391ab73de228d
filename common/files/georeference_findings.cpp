#include "common/files/georeference_findings.hpp"

#include <cmath>
#include <numbers>

#include "common/files/text.hpp"
#include "common/flow/georeference_verdict.hpp"

namespace slammot::files {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

double percent(std::uint32_t part, std::uint32_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::string describe_gnss(const flow::Georeference& georeference) {
  if (georeference.fixes == 0) return "GNSS: no fix";
  if (flow::gnss_contradicts_map(georeference))
    return text("GNSS: %u fixes, error %.1f m, contradicts the map: not used", georeference.fixes,
                georeference.fix_sigma_m);
  if (!georeference.has_position)
    return text("GNSS: %u fixes, too few or too close together", georeference.fixes);
  return text("GNSS: %u fixes, %.0f %% rejected as multipath, error %.1f m, %s", georeference.fixes,
              percent(georeference.rejected_fixes, georeference.fixes), georeference.fix_sigma_m,
              georeference.corrects_map ? "corrects the map" : "agrees with the map");
}

/// A compass that is turned on purpose is turned by a multiple of 90 degrees.
std::string describe_mounting(double bias_rad) {
  constexpr double kQuarter_deg = 90.0;
  constexpr double kLikeQuarter_deg = 20.0;
  const double turn_deg = std::abs(bias_rad) * kDegPerRad;
  const double quarters_deg = kQuarter_deg * std::round(turn_deg / kQuarter_deg);
  const bool is_quarter =
      quarters_deg > 0.0 && std::abs(turn_deg - quarters_deg) < kLikeQuarter_deg;
  return text("mounted at %.0f degrees?", is_quarter ? quarters_deg : turn_deg);
}

std::string describe_compass(const flow::Georeference& georeference) {
  if (georeference.headings == 0) return {};
  std::string line = text("; compass: %u readings", georeference.headings);
  if (georeference.headings == georeference.rejected_headings || !georeference.has_direction)
    return line + ", too few";
  if (georeference.has_position)
    line += text(", bias %.1f degrees", georeference.compass_bias_rad * kDegPerRad);
  if (flow::compass_contradicts_gnss(georeference))
    return line + " against GNSS: " + describe_mounting(georeference.compass_bias_rad) +
           " not used";
  return line + text(", %.0f %% rejected as disturbed, believed",
                     percent(georeference.rejected_headings, georeference.headings));
}

}  // namespace

std::string describe_georeference(const flow::Georeference& georeference) {
  return describe_gnss(georeference) + describe_compass(georeference);
}

}  // namespace slammot::files
