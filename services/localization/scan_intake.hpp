#pragma once

#include <cstddef>
#include <vector>

#include "common/sensing/scan.hpp"
#include "services/localization/companion_echoes.hpp"
#include "services/localization/floor_echoes.hpp"
#include "services/localization/frozen_scanner.hpp"
#include "services/localization/local_map.hpp"
#include "services/localization/localizer_counters.hpp"
#include "services/localization/odometry_prediction.hpp"
#include "services/localization/scan_order.hpp"

namespace slammot::localization {

/// Judges each scan before it is localized: whether it comes in its order, whether the scanner
/// measured anything, and which of its echoes are of the floor or of what goes along with the
/// vehicle.
class ScanIntake {
 public:
  enum class Use {
    kDropped,          ///< A duplicate, out of order or far ahead of all before.
    kPredicted,        ///< Nothing was measured: the prediction is its pose.
    kWithoutReadings,  ///< Nothing was measured for many scans, or scans are rare: dead reckoned
                       ///< like any other.
    kLocalized,
  };

  explicit ScanIntake(double far_ahead_s) : order_(far_ahead_s) {}

  /// To be asked once of each scan, in the order in which they come. The map as it is before the
  /// scan.
  Use judge(const sensing::LaserScan& scan, const OdometryPrediction& prediction,
            const LocalMap& map, LocalizerCounters& counters);

  /// The scan without the floor that its scanner looks down at, for Use::kLocalized. To be asked
  /// once of each; valid until the next call.
  const sensing::LaserScan& without_floor(const sensing::LaserScan& scan,
                                          const OdometryPrediction& prediction,
                                          LocalizerCounters& counters);

  /// The same of a scan that was asked for before.
  const sensing::LaserScan& without_floor_again(const sensing::LaserScan& scan) {
    return floor_.without_floor(scan);
  }

  const FloorEchoes& floor() const { return floor_; }

  /// A scan that is localized or without readings: later ones come after it. Beams that end on what
  /// goes along with the vehicle, ascending; valid until the next call.
  const std::vector<std::size_t>& accept(const sensing::LaserScan& scan,
                                         const OdometryPrediction& prediction);

  /// The same for a scan that is predicted; false for one that has no place among such scans.
  bool accept_blank(const sensing::LaserScan& scan) { return order_.accept_blank(scan); }

 private:
  bool is_in_order(const sensing::LaserScan& scan, const OdometryPrediction& prediction,
                   LocalizerCounters& counters);
  Use without_measurement(const sensing::LaserScan& scan, const OdometryPrediction& prediction);

  int in_a_row_ = 0;  ///< Scans without a measurement.
  ScanOrder order_;
  FrozenScanner frozen_;
  FloorEchoes floor_;
  CompanionEchoes companions_;
};

}  // namespace slammot::localization
