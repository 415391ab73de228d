#pragma once

#include <cstdint>
#include <vector>

#include "common/flow/scan_labels.hpp"
#include "common/flow/tracked_objects.hpp"
#include "common/grids/evidence_grid.hpp"
#include "common/memory/spares.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_config.hpp"

namespace slammot::localization {

/// Objects that tracking published last: where the next scan is expected to see them, and what of
/// the map they drive over.
class ExpectedObjects {
 public:
  /// Margin around the box of a tracked object that is left out of the match.
  static constexpr double kMaskMarginM = 0.4;

  explicit ExpectedObjects(const LocalizerConfig& config) : config_(config) {}

  void expect(const flow::TrackedObjects& objects);

  /// Boxes of confirmed objects at the stamp, with mask_margin_m around them, in odom; none from
  /// objects that are too old. Valid until the next call.
  const std::vector<grids::Box>& masks_at(std::int64_t stamp_ns);

  /// Where a vehicle that is surely moving is seen in the scan of the labels, nothing stands.
  /// Nothing changes where the objects are not those of that scan.
  void drive_over(const flow::ScanLabels& labels, LocalMap& map) const;

 private:
  LocalizerConfig config_;
  flow::TrackedObjects objects_;
  memory::Spares<flow::TrackedObject> spare_objects_;
  std::vector<grids::Box> masks_;
};

}  // namespace slammot::localization
