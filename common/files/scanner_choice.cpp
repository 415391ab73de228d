#include "common/files/scanner_choice.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>

#include "common/files/pose_difference.hpp"

namespace slammot::files {
namespace {

geometry::Pose2 base_from_laser_of(const ScannerSurvey& scanner, const MountingParams& params) {
  if (const auto told = params.base_from_laser(scanner.kind, scanner.slot)) return *told;
  if (const auto recorded = scanner.mounting.constant()) return *recorded;
  const bool looks_back = scanner.slot == 2 && scanner.kind != LaserRecordKind::kBag &&
                          scanner.kind != LaserRecordKind::kRobotLaser1;
  return looks_back ? geometry::Pose2{0.0, 0.0, std::numbers::pi} : geometry::Pose2::identity();
}

/// Ignores a mounting of a further scanner at the vehicle's centre: it is a default.
bool is_mounting_known(const ScannerSurvey& scanner, const MountingParams& params) {
  if (params.base_from_laser(scanner.kind, scanner.slot)) return true;
  const auto recorded = scanner.mounting.constant();
  return recorded && (scanner.kind == LaserRecordKind::kBag ||
                      differ(*recorded, geometry::Pose2::identity(), 0.01, 0.01));
}

/// That of most records, or of the PARAM lines; 0 if there is none.
double stated_max_range_m(const ScannerSurvey& scanner, const MountingParams& params) {
  const auto& scans = scanner.scans_by_recorded_max_range;
  if (scans.empty()) return params.max_range_m(scanner.slot);
  return std::ranges::max_element(scans, {}, [](const auto& range) { return range.second; })->first;
}

/// The stated maximum, if the readings refute it; else 0. In a bag readings beyond it are invalid
/// by definition (sensor_msgs/LaserScan).
double refuted_max_range_m(const ScannerSurvey& scanner, double stated_m) {
  return scanner.kind != LaserRecordKind::kBag && scanner.readings.refutes(stated_m) ? stated_m
                                                                                     : 0.0;
}

}  // namespace

ScannerPlan scanner_plan_of(const ScannerSurvey& scanner, const MountingParams& params) {
  const double stated_m = stated_max_range_m(scanner, params);
  const double refuted_m = refuted_max_range_m(scanner, stated_m);
  return {.name = scanner.scanner,
          .kind = scanner.kind,
          .slot = scanner.slot,
          .scans = scanner.scans,
          .base_from_laser = base_from_laser_of(scanner, params),
          .max_range_m = scanner.readings.max_range_m(refuted_m > 0.0 ? 0.0 : stated_m),
          .refuted_max_range_m = refuted_m,
          .own_body = {},
          .floor = {},
          .mounting_is_known = is_mounting_known(scanner, params),
          .profile_mounting = {}};
}

/// A log may contain the same scans from the scanner and from the base, the latter with poses.
/// Records with poses are preferred, above all ROBOTLASERn, which has more fields. A small number
/// of them does not replace the rest.
std::vector<const ScannerSurvey*> ScannerChoice::best_of_each_slot() const {
  // weight by LaserRecordKind
  constexpr std::array<double, 5> kWorth = {1.0, 1.0 + 1e-9, 0.5, 0.25, 1.0};
  const auto worth = [&](const ScannerSurvey& scanner) {
    return kWorth[static_cast<std::size_t>(scanner.kind)] * static_cast<double>(scanner.scans);
  };
  std::map<std::uint8_t, const ScannerSurvey*> best;
  for (const ScannerSurvey& scanner : scanners_) {
    const ScannerSurvey*& so_far = best[scanner.slot];
    const bool was_asked_for = so_far != nullptr && so_far->scanner == wish_.main;
    if (so_far == nullptr || scanner.scanner == wish_.main ||
        (!was_asked_for && worth(scanner) > worth(*so_far)))
      so_far = &scanner;
  }
  std::vector<const ScannerSurvey*> in_order;
  for (const auto& [slot, scanner] : best) in_order.push_back(scanner);
  return in_order;
}

std::vector<const ScannerSurvey*> ScannerChoice::planar() const {
  std::vector<const ScannerSurvey*> in_order = best_of_each_slot();
  std::erase_if(in_order, [&](const ScannerSurvey* scanner) {
    return profile_mounting(*scanner).has_value();
  });
  std::uint64_t most = 0;
  for (const ScannerSurvey* scanner : in_order) most = std::max(most, scanner->scans);
  auto main = std::ranges::find_if(
      in_order, [&](const ScannerSurvey* scanner) { return scanner->scanner == wish_.main; });
  if (main == in_order.end())
    main = std::ranges::find_if(
        in_order, [&](const ScannerSurvey* scanner) { return 2 * scanner->scans >= most; });
  if (main != in_order.end()) std::rotate(in_order.begin(), main, main + 1);
  return in_order;
}

std::vector<const ScannerSurvey*> ScannerChoice::used() const {
  std::vector<const ScannerSurvey*> scanners = planar();
  const ScannerSurvey* const main = scanners.empty() ? nullptr : scanners.front();
  std::erase_if(scanners, [&](const ScannerSurvey* one) {
    return wish_.used.empty() ? one != main && !is_mounting_known(*one, params_)
                              : std::ranges::find(wish_.used, one->scanner) == wish_.used.end();
  });
  return scanners;
}

/// By the wish, the PARAM lines or the record; none for a scanner that scans the plane.
std::optional<sensing::SpatialMounting> ScannerChoice::profile_mounting(
    const ScannerSurvey& scanner) const {
  const auto said = std::ranges::find(wish_.vertical, scanner.scanner, &VerticalScanner::name);
  if (said != wish_.vertical.end()) return said->mounting;
  if (scanner.mounting.profile_mounting) return scanner.mounting.profile_mounting;
  const sensing::Tilt tilt = params_.tilt(scanner.kind, scanner.slot);
  if (!sensing::scans_vertically(tilt)) return std::nullopt;
  return sensing::in_space(base_from_laser_of(scanner, params_), tilt);
}

std::vector<ScannerPlan> ScannerChoice::profile_plans() const {
  std::vector<ScannerPlan> plans;
  for (const ScannerSurvey* scanner : best_of_each_slot()) {
    const auto mounting = profile_mounting(*scanner);
    if (!mounting) continue;
    plans.push_back(scanner_plan_of(*scanner, params_));
    plans.back().profile_mounting = mounting;
  }
  return plans;
}

}  // namespace slammot::files
