#pragma once

#include <optional>

#include "services/tracking/axis_view.hpp"
#include "services/tracking/projection.hpp"
#include "services/tracking/size_evidence.hpp"

namespace slammot::tracking {

/// Centre of a box along one axis.
struct AxisMeasurement {
  double centre_m = 0.0;      ///< Relative to the predicted centre.
  double variance_m2 = 9.0;   ///< As if unknown, until measured.
  std::optional<int> anchor;  ///< End from which it was measured: -1 low, +1 high, 0 both. A change
                              ///< of size moves the other end.
};

/// Centre along one axis of a box of this size. is_flank_visible: the laser sees the side along the
/// axis.
AxisMeasurement measure_axis(const Size& size, const Projection& projection, const AxisView& view,
                             bool is_flank_visible);

/// Adds what one scan says of the size along the axis.
void add_sizes(SizeEvidence& evidence, const Size& size, const Projection& projection,
               const AxisView& view, bool is_flank_visible);

/// Variance of the step that the centre makes if it is measured from another end than before: the
/// size's error, not motion.
double step_variance_m2(std::optional<int> anchor_before, std::optional<int> anchor,
                        const Size& size);

}  // namespace slammot::tracking
