#include "common/files/carmen_survey.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string_view>
#include <utility>

#include "common/files/pose_difference.hpp"
#include "common/sensing/steady_stamps.hpp"

namespace slammot::files {
namespace {

constexpr std::size_t kReadingBins = 65'000;
constexpr std::size_t kReadingUnits = 131'072;  // 131 m in millimetres
constexpr double kSecondsPerNanosecond = 1e-9;
constexpr double kFarAhead_s = 60.0;

template <typename Count>
double most_frequent(const std::map<double, Count>& counts) {
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0.0 : most->first;
}

/// Quantile of the values at this share; 0 for none.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

/// Quantile of the first `bins` bins' readings at this share [m].
double range_percentile_m(const std::vector<std::uint32_t>& readings_by_cm, std::size_t bins,
                          double share) {
  const auto end =
      readings_by_cm.begin() + static_cast<std::ptrdiff_t>(std::min(bins, readings_by_cm.size()));
  const double total =
      static_cast<double>(std::accumulate(readings_by_cm.begin(), end, std::uint64_t{0}));
  double below = 0.0;
  for (auto bin = readings_by_cm.begin(); bin != end; ++bin) {
    below += *bin;
    if (below > 0.0 && below >= share * total)
      return 0.01 * static_cast<double>(bin - readings_by_cm.begin());
  }
  return 0.0;
}

/// Quantile of the readings at this share [recorded units].
double reading_percentile(const std::vector<std::uint32_t>& readings_by_unit, double share) {
  const double total = static_cast<double>(
      std::accumulate(readings_by_unit.begin(), readings_by_unit.end(), std::uint64_t{0}));
  double below = 0.0;
  for (std::size_t unit = 0; unit < readings_by_unit.size(); ++unit) {
    below += readings_by_unit[unit];
    if (below > 0.0 && below >= share * total) return static_cast<double>(unit);
  }
  return 0.0;
}

std::size_t echo_bins(double max_range_m) {
  return static_cast<std::size_t>(std::max(0.0, max_range_m * 100.0 + 0.5));
}

/// True if successive scans are mostly more units apart than a vehicle drives metres between them.
bool are_in_small_units(const std::vector<matching::ScanPair>& pairs) {
  constexpr double kFarthest_m = 20.0;
  std::vector<double> ways;
  for (const matching::ScanPair& pair : pairs)
    ways.push_back(distance_m(pair.first_recorded, pair.second_recorded));
  return percentile(std::move(ways), 0.5) > kFarthest_m;
}

void set_tilt(std::string_view what, double value, sensing::Tilt& tilt) {
  if (what == "up_offset") tilt.up_m = value;
  if (what == "roll_offset") tilt.roll_rad = value;
  if (what == "pitch_offset") tilt.pitch_rad = value;
}

}  // namespace

std::string enumerated(const std::vector<ScannerPlan>& scanners) {
  std::string names;
  for (const ScannerPlan& scanner : scanners) names += (names.empty() ? "" : ", ") + scanner.name;
  return names;
}

std::optional<Error> select_scanners(const std::vector<std::string>& wanted,
                                     std::vector<ScannerPlan>& scanners) {
  for (const std::string& name : wanted) {
    if (std::ranges::find(scanners, name, &ScannerPlan::name) == scanners.end())
      return Error{"no scanner " + name + ": there are " + enumerated(scanners)};
  }
  if (!wanted.empty())
    std::erase_if(scanners, [&](const ScannerPlan& scanner) {
      return std::ranges::find(wanted, scanner.name) == wanted.end();
    });
  return std::nullopt;
}

/// Discards a first stamp in the future, after which all others would be late.
void CarmenSurvey::ClockCheck::restart_without_first() {
  sensing::StampGuard of_the_others{kFarAhead_s};
  const std::int64_t second_ns = first_ns_[1];
  const std::int64_t third_ns = first_ns_[2];
  begins_ahead_ = second_ns < third_ns && of_the_others.believes(second_ns) &&
                  of_the_others.believes(third_ns) && !of_the_others.believes(first_ns_[0]);
  if (!begins_ahead_) return;
  guard_ = sensing::StampGuard{600.0};
  newest_ns_.reset();
  steps_ns_.clear();
  counts_scans_ = true;
  scans_ = 0;
  advancing_ = 0;
  add(second_ns);
  add(third_ns);
}

void CarmenSurvey::ClockCheck::add(std::optional<std::int64_t> stamp_ns) {
  if (stamp_ns && first_ns_.size() < 3) {
    first_ns_.push_back(*stamp_ns);
    if (first_ns_.size() == 3) restart_without_first();
    if (begins_ahead_) return;
  }
  ++scans_;
  if (!stamp_ns || !guard_.believes(*stamp_ns)) return;
  if (newest_ns_ && *stamp_ns > *newest_ns_) {
    ++advancing_;
    steps_ns_.push_back(*stamp_ns - *newest_ns_);
    counts_scans_ =
        counts_scans_ && steps_ns_.back() == 1'000'000'000 && *stamp_ns % 1'000'000'000 == 0;
  }
  if (!newest_ns_ || *stamp_ns > *newest_ns_) newest_ns_ = stamp_ns;
}

bool CarmenSurvey::ClockCheck::is_usable() const {
  constexpr double kAdvancingShare = 0.9;  // localization handles duplicates and a few late scans
  constexpr double kMinPeriodS = 1e-4;
  constexpr double kMaxPeriodS = 60.0;
  if (scans_ == 0) return false;
  if (scans_ == 1) return newest_ns_.has_value();
  if (counts_scans_ && scans_ > 2) return false;
  if (static_cast<double>(advancing_) < kAdvancingShare * static_cast<double>(scans_ - 1))
    return false;
  const double median_s =
      percentile({steps_ns_.begin(), steps_ns_.end()}, 0.5) * kSecondsPerNanosecond;
  return median_s >= kMinPeriodS && median_s <= kMaxPeriodS;
}

void CarmenSurvey::add(const CarmenRecord& record) {
  ++lines_;
  if (const auto* laser = std::get_if<LaserRecord>(&record)) add_laser(*laser);
  if (const auto* odom = std::get_if<OdometryRecord>(&record)) add_odom(*odom);
  if (const auto* param = std::get_if<ParamRecord>(&record)) add_param(*param);
  if (std::holds_alternative<ImuRecord>(record)) ++imu_lines_;
}

CarmenSurvey::Lasers& CarmenSurvey::lasers_of(const LaserRecord& record) {
  const auto known = std::ranges::find_if(lasers_, [&](const Lasers& lasers) {
    return lasers.kind == record.kind && lasers.slot == record.slot;
  });
  if (known != lasers_.end()) return *known;
  lasers_.emplace_back();
  lasers_.back().kind = record.kind;
  lasers_.back().slot = record.slot;
  lasers_.back().scanner = record.scanner;
  if (newest_odom_) lasers_.back().agreement.add_odom(*newest_odom_);
  if (newest_odom_by_order_) lasers_.back().agreement_by_order.add_odom(*newest_odom_by_order_);
  for (std::size_t kind = 0; kind < odometry_lines_.size(); ++kind)
    lasers_.back().lines_between[kind].since_scan =
        static_cast<std::uint32_t>(odometry_lines_[kind].count);
  return lasers_.back();
}

/// Readings without the echoes of what goes along with the vehicle, which look as if it stood.
std::vector<float> CarmenSurvey::without_companions(const LaserRecord& record,
                                                    const geometry::Pose2& recorded,
                                                    Lasers& lasers) {
  std::vector<float> readings = record.range_m;
  const BeamLayout layout =
      record.layout.value_or(layout_by_convention(readings.size(), std::numbers::pi));
  const geometry::Pose2 moved = lasers.last_recorded
                                    ? geometry::inverse(*lasers.last_recorded) * recorded
                                    : geometry::Pose2{};
  lasers.last_recorded = recorded;
  for (const std::size_t beam :
       lasers.companions.observe({record.range_m, layout.first_beam_rad, layout.beam_step_rad,
                                  std::numeric_limits<double>::infinity()},
                                 moved))
    readings[beam] = std::numeric_limits<float>::quiet_NaN();
  return readings;
}

void CarmenSurvey::add_laser(const LaserRecord& record) {
  Lasers& lasers = lasers_of(record);
  ++lasers.scans;
  ++lasers.scans_by_beams[record.range_m.size()];
  if (record.max_range_m > 0.0) ++lasers.scans_by_recorded_max_range[record.max_range_m];
  if (!lasers.layout) lasers.layout = record.layout;
  lasers.readings_by_cm.resize(kReadingBins);
  lasers.smallest_reading_by_cm.resize(kReadingBins, std::numeric_limits<float>::infinity());
  lasers.readings += record.range_m.size();
  if (std::ranges::none_of(record.range_m,
                           [](float reading) { return reading > 0.0F && std::isfinite(reading); }))
    ++lasers.scans_without_readings;
  lasers.readings_by_unit.resize(kReadingUnits);
  for (const float reading_m : record.range_m) {
    if (reading_m >= 1.0F && reading_m < static_cast<float>(kReadingUnits))
      ++lasers.readings_by_unit[static_cast<std::size_t>(reading_m)];
    const float reading_cm = reading_m * 100.0F + 0.5F;
    if (!(reading_cm >= 1.0F && reading_cm < static_cast<float>(kReadingBins))) continue;
    const auto bin = static_cast<std::size_t>(reading_cm);
    ++lasers.readings_by_cm[bin];
    lasers.smallest_reading_by_cm[bin] = std::min(lasers.smallest_reading_by_cm[bin], reading_m);
  }
  if (record.profile_mounting) lasers.profile_mounting = record.profile_mounting;
  if (record.base_from_laser) {
    if (!lasers.base_from_laser) lasers.base_from_laser = record.base_from_laser;
    lasers.base_from_laser_is_constant =
        lasers.base_from_laser_is_constant &&
        !differ(*lasers.base_from_laser, *record.base_from_laser, 0.01, 0.01);
  }
  const StampedPose pose{record.stamps.ipc_ns.value_or(0), record.wheel_from_base};
  lasers.pose_changes =
      lasers.pose_changes || (!lasers.poses.empty() && differ(lasers.poses.front().wheel_from_base,
                                                              record.wheel_from_base, 1e-9, 1e-9));
  lasers.poses.push_back(pose);
  lasers.held_poses.add(record.wheel_from_base);
  lasers.pose_noise.add(record.wheel_from_base);
  lasers.own_body.add(record.range_m);
  lasers.odometry_check.add(record.wheel_from_base);
  const geometry::Pose2& recorded =
      lasers.pose_changes ? record.wheel_from_base : chosen_odometry_lines().last_pose;
  const std::vector<float> readings = without_companions(record, recorded, lasers);
  lasers.moved_pairs.add(readings, recorded, lasers.poses.size() - 1);
  lasers.pairs_in_small_units.add(readings, recorded, lasers.poses.size() - 1);
  lasers.turned_pairs.add(readings, recorded, lasers.poses.size() - 1);
  lasers.timing_pairs.add(readings, recorded, lasers.poses.size() - 1);
  lasers.ipc_ns.push_back(record.stamps.ipc_ns);
  lasers.logger_ns.push_back(record.stamps.logger_ns);
  for (std::size_t kind = 0; kind < odometry_lines_.size(); ++kind) {
    Lasers::LinesBetween& between = lasers.lines_between[kind];
    between.before_scan.push_back(std::exchange(between.since_scan, 0));
    between.pose_before_scan.push_back(odometry_lines_[kind].last_pose);
  }
  lasers.ipc_clock.add(record.stamps.ipc_ns);
  lasers.logger_clock.add(record.stamps.logger_ns);
  if (record.stamps.ipc_ns) lasers.agreement.add_laser(pose);
  lasers.agreement_by_order.add_laser({lines_, record.wheel_from_base});
}

void CarmenSurvey::add_odom(const OdometryRecord& record) {
  const auto kind = static_cast<std::size_t>(record.kind);
  OdometryLines& lines = odometry_lines_[kind];
  ++lines.count;
  if (!lines.first_pose) lines.first_pose = record.wheel_from_base;
  lines.pose_changes =
      lines.pose_changes || differ(*lines.first_pose, record.wheel_from_base, 1e-9, 1e-9);
  lines.last_pose = record.wheel_from_base;
  lines.check.add(record.wheel_from_base);
  lines.noise.add(record.wheel_from_base);
  lines.poses.push_back(record.wheel_from_base);
  lines.ipc_ns.push_back(record.stamps.ipc_ns);
  lines.logger_ns.push_back(record.stamps.logger_ns);
  for (Lasers& lasers : lasers_) ++lasers.lines_between[kind].since_scan;
  if (record.kind == odometry_lines()) {
    newest_odom_by_order_ = {lines_, record.wheel_from_base};
    for (Lasers& lasers : lasers_) lasers.agreement_by_order.add_odom(*newest_odom_by_order_);
  }
  if (!record.stamps.ipc_ns || record.kind != OdometryRecordKind::kOdom) return;
  newest_odom_ = {*record.stamps.ipc_ns, record.wheel_from_base};
  for (Lasers& lasers : lasers_) lasers.agreement.add_odom(*newest_odom_);
}

/// TRUEPOS is used only if the log has no other odometry.
OdometryRecordKind CarmenSurvey::odometry_lines() const {
  return odometry_lines_[0].count == 0 && odometry_lines_[1].count > 0
             ? OdometryRecordKind::kTruePos
             : OdometryRecordKind::kOdom;
}

void CarmenSurvey::add_param(const ParamRecord& record) {
  constexpr std::array<std::string_view, 2> kLaser = {"robot_frontlaser_", "robot_rearlaser_"};
  constexpr std::array<std::string_view, 2> kMaxRange = {"robot_front_laser_max",
                                                         "robot_rear_laser_max"};
  double value = 0.0;
  const auto [end, fault] =
      std::from_chars(record.value.data(), record.value.data() + record.value.size(), value);
  if (fault != std::errc() || !(std::abs(value) < 1000.0)) return;
  for (std::size_t slot = 0; slot < params_.size(); ++slot) {
    if (record.name == kMaxRange[slot] && value > 0.0)
      params_[slot].max_range_m = static_cast<double>(static_cast<float>(value));
    if (!record.name.starts_with(kLaser[slot]) || !(std::abs(value) < 100.0)) continue;
    const std::string_view what = record.name.substr(kLaser[slot].size());
    if (what == "offset") params_[slot].offset[0] = value;
    if (what == "side_offset") params_[slot].offset[1] = value;
    if (what == "angular_offset") params_[slot].offset[2] = value;
    set_tilt(what, value, params_[slot].tilt);
  }
  constexpr std::string_view kNumbered = "robot_laser";
  if (!record.name.starts_with(kNumbered) || record.name.size() < kNumbered.size() + 2 ||
      !(std::abs(value) < 100.0))
    return;
  const char digit = record.name[kNumbered.size()];
  if (digit < '1' || digit > '9' || record.name[kNumbered.size() + 1] != '_') return;
  const std::string_view what = record.name.substr(kNumbered.size() + 2);
  LaserParams& numbered = numbered_params_[static_cast<std::size_t>(digit - '1')];
  if (what == "offset") numbered.offset[0] = value;
  if (what == "side_offset") numbered.offset[1] = value;
  if (what == "angular_offset") numbered.offset[2] = value;
  set_tilt(what, value, numbered.tilt);
}

/// A log may contain the same scans from the scanner and from the base, the latter with poses.
/// Records with poses are preferred, above all ROBOTLASERn, which has more fields. A small number
/// of them does not replace the rest.
std::vector<const CarmenSurvey::Lasers*> CarmenSurvey::best_of_each_slot(
    const ScannerWish& wish) const {
  // weight by LaserRecordKind
  constexpr std::array<double, 5> kWorth = {1.0, 1.0 + 1e-9, 0.5, 0.25, 1.0};
  const auto worth = [&](const Lasers& lasers) {
    return kWorth[static_cast<std::size_t>(lasers.kind)] * static_cast<double>(lasers.scans);
  };
  std::map<std::uint8_t, const Lasers*> best;
  for (const Lasers& lasers : lasers_) {
    const Lasers*& so_far = best[lasers.slot];
    const bool was_asked_for = so_far != nullptr && so_far->scanner == wish.main;
    if (so_far == nullptr || lasers.scanner == wish.main ||
        (!was_asked_for && worth(lasers) > worth(*so_far)))
      so_far = &lasers;
  }
  std::vector<const Lasers*> in_order;
  for (const auto& [slot, lasers] : best) in_order.push_back(lasers);
  return in_order;
}

/// Those that may be localized. The main scanner is the first that is not much rarer than any
/// other.
std::vector<const CarmenSurvey::Lasers*> CarmenSurvey::planar_scanners(
    const ScannerWish& wish) const {
  std::vector<const Lasers*> in_order = best_of_each_slot(wish);
  std::erase_if(in_order,
                [&](const Lasers* lasers) { return profile_mounting(*lasers, wish).has_value(); });
  std::uint64_t most = 0;
  for (const Lasers* lasers : in_order) most = std::max(most, lasers->scans);
  auto main = std::ranges::find_if(
      in_order, [&](const Lasers* lasers) { return lasers->scanner == wish.main; });
  if (main == in_order.end())
    main = std::ranges::find_if(in_order,
                                [&](const Lasers* lasers) { return 2 * lasers->scans >= most; });
  if (main != in_order.end()) std::rotate(in_order.begin(), main, main + 1);
  return in_order;
}

/// Another scanner is used only if its mounting is known: a guess would distort the map.
std::vector<const CarmenSurvey::Lasers*> CarmenSurvey::lasers_to_use(
    const ScannerWish& wish) const {
  std::vector<const Lasers*> lasers = planar_scanners(wish);
  const Lasers* const main = lasers.empty() ? nullptr : lasers.front();
  std::erase_if(lasers, [&](const Lasers* one) {
    return wish.used.empty() ? one != main && !mounting_is_known(*one)
                             : std::ranges::find(wish.used, one->scanner) == wish.used.end();
  });
  return lasers;
}

ScannerPlan CarmenSurvey::scanner_plan(const Lasers& lasers) const {
  return {.name = lasers.scanner,
          .kind = lasers.kind,
          .slot = lasers.slot,
          .scans = lasers.scans,
          .base_from_laser = base_from_laser(lasers),
          .max_range_m = max_range_m(lasers),
          .own_body = {},
          .mounting_is_known = mounting_is_known(lasers),
          .profile_mounting = {}};
}

/// By the wish, the PARAM lines or the record; none for a scanner that scans the plane.
std::optional<sensing::SpatialMounting> CarmenSurvey::profile_mounting(
    const Lasers& lasers, const ScannerWish& wish) const {
  const auto said = std::ranges::find(wish.vertical, lasers.scanner, &VerticalScanner::name);
  if (said != wish.vertical.end()) return said->mounting;
  if (lasers.profile_mounting) return lasers.profile_mounting;
  const sensing::Tilt& tilt = params_of(lasers).tilt;
  if (!sensing::scans_vertically(tilt)) return std::nullopt;
  return sensing::in_space(base_from_laser(lasers), tilt);
}

bool CarmenSurvey::has_scanner(const std::string& name) const {
  return std::ranges::any_of(lasers_, [&](const Lasers& lasers) { return lasers.scanner == name; });
}

std::vector<ScannerPlan> CarmenSurvey::scanners(const ScannerWish& wish) const {
  std::vector<ScannerPlan> plans;
  for (const Lasers* lasers : planar_scanners(wish)) plans.push_back(scanner_plan(*lasers));
  return plans;
}

std::vector<ScannerPlan> CarmenSurvey::profile_scanners(const ScannerWish& wish) const {
  std::vector<ScannerPlan> plans;
  for (const Lasers* lasers : best_of_each_slot(wish)) {
    const auto mounting = profile_mounting(*lasers, wish);
    if (!mounting) continue;
    plans.push_back(scanner_plan(*lasers));
    plans.back().profile_mounting = mounting;
  }
  return plans;
}

LogPlan CarmenSurvey::conclude(double fallback_field_of_view_rad, const ScannerWish& wish) const {
  LogPlan plan;
  const std::vector<const Lasers*> to_use = lasers_to_use(wish);
  for (const Lasers* scanner : planar_scanners(wish)) {
    const bool is_used = std::ranges::find(to_use, scanner) != to_use.end();
    if (!is_used && wish.used.empty()) plan.unplaced_scanners.push_back(scanner->scanner);
  }
  std::vector<Lasers> scanners;  // in metres
  for (const Lasers* scanner : to_use) scanners.push_back(*scanner);
  if (scanners.empty()) scanners.emplace_back();
  const Lasers& lasers = scanners.front();
  plan.laser = lasers.kind;
  plan.odometry_lines = odometry_lines();
  const double range_unit_m =
      matching::range_unit_of(reading_percentile(lasers.readings_by_unit, 0.5),
                              reading_percentile(lasers.readings_by_unit, 0.9));
  const auto convert_to = [&](double unit_m) {
    for (Lasers& scanner : scanners) convert_readings(scanner, unit_m);
  };
  if (range_unit_m != 1.0) convert_to(range_unit_m);
  plan.max_range_m = max_range_m(lasers);
  plan.evidence.correction.range_unit_m = range_unit_m;
  plan.base_from_laser = base_from_laser(lasers);
  plan.evidence = weigh(lasers, plan, fallback_field_of_view_rad);
  if (plan.evidence.correction.range_unit_m != range_unit_m) {
    convert_to(plan.evidence.correction.range_unit_m);
    plan.max_range_m = max_range_m(lasers);
  }
  if (plan.evidence.correction.laser_turn_rad != 0.0)
    plan.base_from_laser.heading_rad = geometry::wrap_angle(
        plan.base_from_laser.heading_rad + plan.evidence.correction.laser_turn_rad);
  choose_clock(lasers, plan);
  plan.odometry_held_scans = lasers.held_poses.most_scans();
  plan.odometry = odometry_source(lasers, plan);
  remove_noise_of_odometry_stamps(plan);
  plan.odometry_late_s = odometry_lateness_s(lasers, plan, fallback_field_of_view_rad);
  if (plan.is_timed_by_order())
    plan.odom_lines_before_scan =
        lasers.lines_between[static_cast<std::size_t>(plan.odometry_lines)].before_scan;
  plan.figures = figures(lasers, plan, fallback_field_of_view_rad);
  treat_poor_odometry(lasers, plan);
  if (lasers.scans == 0) return plan;
  for (const Lasers& scanner : scanners) {
    plan.scanners.push_back(scanner_plan(scanner));
    plan.scanners.back().own_body =
        scanner.own_body.conclude(plan.evidence.correction.range_unit_m);
  }
  plan.scanners.front().base_from_laser = plan.base_from_laser;
  plan.profile_scanners = profile_scanners(wish);
  return plan;
}

/// Counts readings in another unit by centimetres, like those in metres.
void CarmenSurvey::convert_readings(Lasers& lasers, double unit_m) {
  std::fill(lasers.readings_by_cm.begin(), lasers.readings_by_cm.end(), 0);
  std::fill(lasers.smallest_reading_by_cm.begin(), lasers.smallest_reading_by_cm.end(),
            std::numeric_limits<float>::infinity());
  for (std::size_t unit = 1; unit < lasers.readings_by_unit.size(); ++unit) {
    const auto reading_m = static_cast<float>(unit) * static_cast<float>(unit_m);
    const auto bin = static_cast<std::size_t>(reading_m * 100.0F + 0.5F);
    if (lasers.readings_by_unit[unit] == 0 || bin >= kReadingBins) continue;
    lasers.readings_by_cm[bin] += lasers.readings_by_unit[unit];
    lasers.smallest_reading_by_cm[bin] = std::min(lasers.smallest_reading_by_cm[bin], reading_m);
  }
}

/// Readings that are no echo, or of the vehicle itself, become NaN.
std::vector<matching::ScanPair> CarmenSurvey::with_echoes_of_others(
    const Lasers& lasers, const LogPlan& plan, std::vector<matching::ScanPair> pairs) {
  const double unit_m = plan.evidence.correction.range_unit_m;
  const auto no_echo = static_cast<float>(plan.max_range_m / unit_m);
  const sensing::OwnBody own_body = lasers.own_body.conclude(unit_m);
  const auto leave_out = [&](std::vector<float>& ranges) {
    own_body.hide(ranges, std::numeric_limits<float>::quiet_NaN());
    for (float& range : ranges)
      range = range > 0.0F && range < no_echo ? range : std::numeric_limits<float>::quiet_NaN();
  };
  for (matching::ScanPair& pair : pairs) {
    leave_out(pair.first);
    leave_out(pair.second);
  }
  return pairs;
}

/// Of scans with so many beams.
matching::AssumedBeams CarmenSurvey::assumed_beams(const Lasers& lasers, const LogPlan& plan,
                                                   std::size_t beams,
                                                   double fallback_field_of_view_rad) {
  const BeamLayout layout =
      lasers.layout.value_or(layout_by_convention(beams, fallback_field_of_view_rad));
  return {layout.first_beam_rad, layout.beam_step_rad, plan.base_from_laser.heading_rad,
          plan.base_from_laser.translation_m()};
}

/// Matches the sampled pairs, without no-echo readings. Odometry is judged by ODOM lines if there
/// are any, because scan intervals hide the arcs of single steps. Without odometry nothing
/// contradicts the stated layout.
matching::LogEvidence CarmenSurvey::weigh(const Lasers& lasers, const LogPlan& plan,
                                          double fallback_field_of_view_rad) const {
  const bool has_small_units = are_in_small_units(lasers.moved_pairs.pairs());
  std::vector<matching::ScanPair> pairs =
      has_small_units ? lasers.pairs_in_small_units.pairs() : lasers.moved_pairs.pairs();
  pairs.insert(pairs.end(), lasers.turned_pairs.pairs().begin(), lasers.turned_pairs.pairs().end());
  if (pairs.empty()) return plan.evidence;
  pairs = with_echoes_of_others(lasers, plan, std::move(pairs));
  return matching::weigh_log(
      pairs, assumed_beams(lasers, plan, pairs.front().first.size(), fallback_field_of_view_rad),
      chosen_odometry_lines().pose_changes ? chosen_odometry_lines().check : lasers.odometry_check,
      plan.evidence.correction.range_unit_m);
}

/// A pair begins at the end of the one before; if there are too many pairs, every other one is
/// dropped.
void CarmenSurvey::PairSample::add(const std::vector<float>& ranges,
                                   const geometry::Pose2& recorded, std::size_t scan) {
  constexpr std::size_t kMostScansBetween = 40;
  const bool has_moved = anchor_ && differ(anchor_->second, recorded, moved_m_, turned_rad_);
  if (anchor_ && !has_moved && ++scans_since_anchor_ < kMostScansBetween) return;
  const bool is_wanted = has_moved && anchor_->first.size() == ranges.size() &&
                         distance_m(anchor_->second, recorded) <= most_m_;
  if (is_wanted && offered_++ % every_ == 0)
    pairs_.push_back(
        {std::move(anchor_->first), ranges, anchor_->second, recorded, anchor_scan_, scan});
  anchor_.emplace(ranges, recorded);
  anchor_scan_ = scan;
  scans_since_anchor_ = 0;
  if (pairs_.size() <= kMost) return;
  every_ *= 2;
  std::vector<matching::ScanPair> kept;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) kept.push_back(std::move(pairs_[i]));
  pairs_ = std::move(kept);
}

/// Recorded stamps of one of the two clocks, with the way between scans.
std::vector<sensing::ScanMark> CarmenSurvey::scan_marks(const Lasers& lasers,
                                                        const matching::LogCorrection& correction,
                                                        LogClock clock) const {
  std::vector<sensing::ScanMark> marks(lasers.scans);
  const std::vector<geometry::Pose2>& of_lines =
      lasers.lines_between[static_cast<std::size_t>(odometry_lines())].pose_before_scan;
  const auto pose = [&](std::size_t i) {
    return corrected(correction,
                     lasers.pose_changes ? lasers.poses[i].wheel_from_base : of_lines[i]);
  };
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (clock != LogClock::kNominal) marks[i].stamp_ns = lasers.stamps_ns(clock)[i];
    if (i == 0) continue;
    marks[i].way_m = distance_m(pose(i - 1), pose(i));
    marks[i].turn_rad =
        std::abs(geometry::wrap_angle(pose(i).heading_rad - pose(i - 1).heading_rad));
  }
  return marks;
}

std::optional<LogClock> CarmenSurvey::clock_of_disordered_scans() const {
  constexpr double kFewLate = 0.02;
  for (const Lasers& lasers : lasers_) {
    for (const LogClock clock : {LogClock::kIpc, LogClock::kLogger}) {
      std::vector<std::int64_t> stamps_ns;
      std::size_t late = 0;
      for (const auto& stamp_ns : lasers.stamps_ns(clock)) {
        if (!stamp_ns) continue;
        late += !stamps_ns.empty() && *stamp_ns < stamps_ns.back() ? 1 : 0;
        stamps_ns.push_back(*stamp_ns);
      }
      if (static_cast<double>(late) > kFewLate * static_cast<double>(stamps_ns.size()) &&
          sensing::are_regular_in_another_order(stamps_ns))
        return clock;
    }
  }
  return std::nullopt;
}

/// Chooses a faultless clock, ipc before logger; otherwise one that can be repaired; otherwise
/// derives time from the way.
void CarmenSurvey::choose_clock(const Lasers& lasers, LogPlan& plan) const {
  plan.clock = LogClock::kNominal;
  if (lasers.scans == 0) return;
  const std::array clocks{LogClock::kIpc, LogClock::kLogger};
  std::array<sensing::ScanTimes, 2> times;
  const sensing::WayPace pace = sensing::pace_among(
      range_percentile_m(lasers.readings_by_cm, echo_bins(plan.max_range_m), 0.5));
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    const auto marks = scan_marks(lasers, plan.evidence.correction, clocks[i]);
    times[i] = sensing::judge_scan_stamps(marks);
    if (times[i].fault == sensing::ClockFault::kIndex && sensing::may_count_seconds(marks, pace))
      times[i] = {};
  }
  const auto take = [&](std::size_t i) {
    plan.clock = clocks[i];
    plan.times = std::move(times[i]);
  };
  const std::array<const ClockCheck*, 2> checks{&lasers.ipc_clock, &lasers.logger_clock};
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    const bool begins_ahead = checks[i]->is_usable() && checks[i]->begins_ahead();
    const bool is_sound = times[i].fault == sensing::ClockFault::kNone ||
                          times[i].fault == sensing::ClockFault::kNoisy;
    if (!begins_ahead && !is_sound) continue;
    take(i);
    if (begins_ahead) plan.times = {};
    plan.first_scan_is_ahead = begins_ahead;
    return;
  }
  for (std::size_t i = 0; i < clocks.size(); ++i) {
    if (times[i].is_clock) return take(i);
  }
  plan.times = std::move(times[times[0].fault == sensing::ClockFault::kAbsent ? 1 : 0]);
  plan.times.stamps_ns = sensing::stamps_from_way(
      scan_marks(lasers, plan.evidence.correction, LogClock::kNominal), pace);
}

/// "No echo" is a reading that repeats at the far end of the range. Some scanners have several such
/// codes within a percent (LMS: 81.83, 81.90, 81.91); the smallest is used. If the far end does not
/// repeat, every reading is an echo. A record's own maximum holds unless the data have a code below
/// it.
double CarmenSurvey::max_range_m(const Lasers& lasers) const {
  constexpr double kCodeShare = 1e-3;  // of all readings
  constexpr std::uint64_t kCodeCount = 5;
  const double param_m =
      lasers.slot <= params_.size() ? params_[lasers.slot - 1].max_range_m.value_or(0.0) : 0.0;
  const double recorded_m = lasers.scans_by_recorded_max_range.empty()
                                ? param_m
                                : most_frequent(lasers.scans_by_recorded_max_range);
  const auto& counts = lasers.readings_by_cm;
  const auto last =
      std::find_if(counts.rbegin(), counts.rend(), [](std::uint32_t count) { return count > 0; });
  if (last == counts.rend()) return recorded_m > 0.0 ? recorded_m : 1.0;
  const auto last_bin = static_cast<std::size_t>(counts.rend() - last) - 1;
  const double total =
      static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  const auto is_code = [&](std::size_t bin) {
    return counts[bin] >= kCodeCount && counts[bin] >= kCodeShare * total;
  };
  for (std::size_t bin = last_bin - last_bin / 100; bin <= last_bin; ++bin) {
    if (!is_code(bin)) continue;
    const double code_m = static_cast<double>(lasers.smallest_reading_by_cm[bin]);
    return recorded_m > 0.0 ? std::min(recorded_m, code_m) : code_m;
  }
  return recorded_m > 0.0 ? recorded_m : 0.01 * static_cast<double>(last_bin + 1);
}

const CarmenSurvey::LaserParams& CarmenSurvey::params_of(const Lasers& lasers) const {
  static const LaserParams kNone;
  if (lasers.kind == LaserRecordKind::kBag || lasers.slot < 1 ||
      lasers.slot > numbered_params_.size())
    return kNone;
  const LaserParams& numbered = numbered_params_[lasers.slot - 1];
  return numbered.tell_mounting() || lasers.slot > params_.size() ? numbered
                                                                  : params_[lasers.slot - 1];
}

/// Ignores a mounting of a further scanner at the vehicle's centre: it is a default.
bool CarmenSurvey::mounting_is_known(const Lasers& lasers) const {
  if (params_of(lasers).tell_mounting()) return true;
  if (!lasers.base_from_laser || !lasers.base_from_laser_is_constant) return false;
  return lasers.kind == LaserRecordKind::kBag ||
         differ(*lasers.base_from_laser, geometry::Pose2::identity(), 0.01, 0.01);
}

geometry::Pose2 CarmenSurvey::base_from_laser(const Lasers& lasers) const {
  const bool is_rear = lasers.slot == 2 && lasers.kind != LaserRecordKind::kBag;
  const LaserParams& params = params_of(lasers);
  const auto& [x_m, y_m, heading_rad] = params.offset;
  if (params.tell_mounting() && is_rear && &params == &params_[1]) {
    // The rear laser looks backwards from behind the centre, whatever the sign of its recorded
    // offset.
    return {-std::abs(x_m.value_or(0.0)), y_m.value_or(0.0),
            heading_rad.value_or(std::numbers::pi)};
  }
  if (params.tell_mounting())
    return {x_m.value_or(0.0), y_m.value_or(0.0), heading_rad.value_or(0.0)};
  if (lasers.base_from_laser && lasers.base_from_laser_is_constant) return *lasers.base_from_laser;
  return is_rear && lasers.kind != LaserRecordKind::kRobotLaser1
             ? geometry::Pose2{0.0, 0.0, std::numbers::pi}
             : geometry::Pose2::identity();
}

LogFigures CarmenSurvey::figures(const Lasers& lasers, const LogPlan& plan,
                                 double fallback_field_of_view_rad) const {
  LogFigures figures;
  figures.scans = lasers.scans;
  figures.odom_lines = odometry_lines_[0].count;
  figures.imu_lines = imu_lines_;
  figures.has_clock = plan.clock != LogClock::kNominal;
  if (lasers.scans == 0) return figures;
  std::map<double, std::uint64_t> scans_by_beams(lasers.scans_by_beams.begin(),
                                                 lasers.scans_by_beams.end());
  figures.beams = static_cast<std::size_t>(most_frequent(scans_by_beams));
  const BeamLayout layout =
      lasers.layout.value_or(layout_by_convention(figures.beams, fallback_field_of_view_rad));
  figures.field_of_view_rad =
      std::min(std::abs(plan.evidence.correction.field_factor * layout.beam_step_rad) *
                   static_cast<double>(figures.beams),
               2.0 * std::numbers::pi);
  figures.max_range_m = plan.max_range_m;
  figures.median_range_m =
      range_percentile_m(lasers.readings_by_cm, echo_bins(plan.max_range_m), 0.5);
  figures.far_range_m = range_percentile_m(lasers.readings_by_cm, echo_bins(plan.max_range_m), 0.9);
  std::vector<double> periods_s;
  std::vector<double> speeds_mps;
  const std::vector<sensing::ScanMark> marks =
      scan_marks(lasers, plan.evidence.correction, plan.clock);
  figures.scans_without_readings = lasers.scans_without_readings;
  const auto echoes_end = lasers.readings_by_cm.begin() +
                          static_cast<std::ptrdiff_t>(
                              std::min(echo_bins(plan.max_range_m), lasers.readings_by_cm.size()));
  figures.echo_share = static_cast<double>(std::accumulate(lasers.readings_by_cm.begin(),
                                                           echoes_end, std::uint64_t{0})) /
                       static_cast<double>(std::max<std::uint64_t>(1, lasers.readings));
  figures.comes_by_time = !figures.has_clock && sensing::comes_by_time(marks);
  const auto stamp_ns = [&](std::size_t i) {
    return plan.times.stamps_ns.empty() ? marks[i].stamp_ns
                                        : std::optional(plan.times.stamps_ns[i]);
  };
  for (std::size_t i = 1; i < marks.size(); ++i) {
    figures.distance_m += marks[i].way_m;
    if (!stamp_ns(i - 1) || !stamp_ns(i) || *stamp_ns(i) <= *stamp_ns(i - 1)) continue;
    periods_s.push_back(static_cast<double>(*stamp_ns(i) - *stamp_ns(i - 1)) *
                        kSecondsPerNanosecond);
    speeds_mps.push_back(marks[i].way_m / periods_s.back());
  }
  figures.scan_period_s = percentile(periods_s, 0.5);
  figures.longest_gap_s = percentile(periods_s, 1.0);
  if (figures.scan_period_s > 0.0 && !periods_s.empty()) {
    figures.scan_period_spread =
        (percentile(periods_s, 0.9) - percentile(periods_s, 0.1)) / figures.scan_period_s;
  }
  figures.duration_s = std::accumulate(periods_s.begin(), periods_s.end(), 0.0);
  if (figures.has_clock) figures.cruising_speed_mps = percentile(speeds_mps, 0.9);
  return figures;
}

}  // namespace slammot::files
