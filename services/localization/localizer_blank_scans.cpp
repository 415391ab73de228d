#include <utility>

#include "services/localization/blind_scan.hpp"
#include "services/localization/localizer.hpp"

namespace slammot::localization {

bool Localizer::has_rare_scans() const {
  return prediction_.state().belief.usual_step_s >= sensing::kRareScans_s;
}

/// Rare scans are dead reckoned like any other.
bool Localizer::measures_nothing(const sensing::LaserScan& scan) const {
  return sensing::is_blank(scan, prediction_.state().belief.usual_step_s) ||
         (prediction_.last() && !has_rare_scans() &&
          is_blind(scan, odom_from_base(), submaps_.map()));
}

/// A blank scan measures nothing: its pose is the prediction, the estimate stays as it is, and
/// nothing goes into the map. Its labels are awaited like those of any scan.
std::optional<flow::LocalizedScan> Localizer::predict_blank(const sensing::LaserScan& scan,
                                                            flow::LocalizedScan workspace) {
  if (scan.range_m.empty() || !prediction_.last() || !order_.accept_blank(scan))
    return std::nullopt;
  const Step step = prediction_.predict(scan.stamp_ns);
  const sensing::LaserScan without_beams{scan.stamp_ns, scan.sequence, scan.scanner, {}};
  return describe_and_remember(without_beams, {step.after, step.speed_mps, step.yaw_rate_radps},
                               MapAdmission::kWithheld, std::move(workspace));
}

}  // namespace slammot::localization
