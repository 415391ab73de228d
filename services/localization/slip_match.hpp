#pragma once

#include "services/localization/localizer_config.hpp"
#include "services/localization/mixture_match.hpp"
#include "services/localization/scan_matcher.hpp"
#include "services/localization/step_to_explain.hpp"

namespace slammot::localization {

/// Finds the pose of a scan where wheels slip: each hypothesis of the slip is matched for itself,
/// from the pose that it leads to, and weighed by its match. The hypothesis that is the likeliest
/// so far is the step. Steps of the scan: one a hypothesis.
ExplainedStep explain_slip(const StepToExplain& scan, const LocalizerConfig& config,
                           ScanMatcher& matcher);

}  // namespace slammot::localization
