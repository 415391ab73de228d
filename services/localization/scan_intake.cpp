#include "services/localization/scan_intake.hpp"

#include "services/localization/blind_scan.hpp"

namespace slammot::localization {
namespace {

constexpr int kDeadReckonedFrom = 10;  // scans in a row that measure nothing

/// Rare scans are dead reckoned like any other.
bool measures_nothing(const sensing::LaserScan& scan, const OdometryPrediction& prediction,
                      const LocalMap& map) {
  return sensing::is_blank(scan, prediction.state().belief.usual_step_s) ||
         (prediction.last() && !prediction.has_rare_scans() &&
          is_blind(scan, prediction.estimate().odom_from_base, map));
}

}  // namespace

bool ScanIntake::is_in_order(const sensing::LaserScan& scan, const OdometryPrediction& prediction,
                             LocalizerCounters& counters) {
  switch (order_.judge(scan, prediction.last_stamp_ns())) {
    case ScanOrder::Verdict::kUsable: return true;
    case ScanOrder::Verdict::kDuplicate: ++counters.scans.duplicate; break;
    case ScanOrder::Verdict::kOutOfOrder: ++counters.scans.out_of_order; break;
    case ScanOrder::Verdict::kFarAhead: ++counters.scans.far_ahead; break;
  }
  return false;
}

ScanIntake::Use ScanIntake::judge(const sensing::LaserScan& scan,
                                  const OdometryPrediction& prediction, const LocalMap& map,
                                  LocalizerCounters& counters) {
  if (!is_in_order(scan, prediction, counters)) return Use::kDropped;
  if (frozen_.repeats(scan, prediction.wheel_from_base_at(scan.stamp_ns)) && prediction.last()) {
    ++counters.scans.frozen;
    return without_measurement(scan, prediction);
  }
  if (measures_nothing(scan, prediction, map)) {
    ++counters.scans.blank;
    return without_measurement(scan, prediction);
  }
  in_a_row_ = 0;
  return Use::kLocalized;
}

/// A few such scans are bridged by the next one's step. Over many the vehicle may drive, turn and
/// stand, which one step does not tell.
ScanIntake::Use ScanIntake::without_measurement(const sensing::LaserScan& scan,
                                                const OdometryPrediction& prediction) {
  if (in_a_row_ < kDeadReckonedFrom) ++in_a_row_;
  const bool is_dead_reckoned = prediction.has_rare_scans() || in_a_row_ == kDeadReckonedFrom;
  return is_dead_reckoned && prediction.last() && !scan.range_m.empty() ? Use::kWithoutReadings
                                                                        : Use::kPredicted;
}

const sensing::LaserScan& ScanIntake::without_floor(const sensing::LaserScan& scan,
                                                    const OdometryPrediction& prediction,
                                                    LocalizerCounters& counters) {
  const sensing::LaserScan& seen =
      floor_.leave_out(scan, prediction.wheel_from_base_at(scan.stamp_ns));
  if (&seen != &scan) ++counters.scans.with_floor;
  return seen;
}

const std::vector<std::size_t>& ScanIntake::accept(const sensing::LaserScan& scan,
                                                   const OdometryPrediction& prediction) {
  order_.accept(scan, prediction.last_stamp_ns());
  return companions_.of(scan, prediction.wheel_from_base_at(scan.stamp_ns));
}

}  // namespace slammot::localization
