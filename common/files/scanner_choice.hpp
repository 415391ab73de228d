#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "common/files/log_plan.hpp"
#include "common/files/mounting_params.hpp"
#include "common/files/scanner_survey.hpp"

namespace slammot::files {

/// Mounting and maximum range by the PARAM lines, the records and the readings.
ScannerPlan scanner_plan_of(const ScannerSurvey& scanner, const MountingParams& params);

/// Which scanners of a log are used for what.
class ScannerChoice {
 public:
  /// All must outlive this.
  ScannerChoice(const std::deque<ScannerSurvey>& scanners, const MountingParams& params,
                const ScannerWish& wish)
      : scanners_(scanners), params_(params), wish_(wish) {}

  /// Those that may be localized. The main scanner comes first: the first that is not much rarer
  /// than any other.
  std::vector<const ScannerSurvey*> planar() const;

  /// Those of planar() that are localized. Another scanner than the main one is used only if its
  /// mounting is known: a guess would distort the map.
  std::vector<const ScannerSurvey*> used() const;

  /// Those that scan a vertical profile.
  std::vector<ScannerPlan> profile_plans() const;

 private:
  std::vector<const ScannerSurvey*> best_of_each_slot() const;
  std::optional<sensing::SpatialMounting> profile_mounting(const ScannerSurvey& scanner) const;

  const std::deque<ScannerSurvey>& scanners_;
  const MountingParams& params_;
  const ScannerWish& wish_;
};

}  // namespace slammot::files
