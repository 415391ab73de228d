#include "common/files/log_findings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/files/text.hpp"

namespace slammot::files {
namespace {

using sensing::ClockFault;

std::string made_from_way(const LogPlan& plan) {
  if (plan.odometry == OdometrySource::kNone)
    return text("a scan is taken to come every %.2f s, no speed is known", 1.0 / kNominalRateHz);
  return "time is made from the way between scans, no speed is known";
}

const char* name_of_unit(double unit_s) {
  return unit_s > 0.5e-3 ? "milliseconds" : unit_s > 0.5e-6 ? "microseconds" : "nanoseconds";
}

std::string describe_clock(const LogPlan& plan) {
  switch (plan.times.fault) {
    case ClockFault::kNone: return {};
    case ClockFault::kAbsent: return "scans have no stamps: " + made_from_way(plan);
    case ClockFault::kConstant: return "all scans have the same stamp: " + made_from_way(plan);
    case ClockFault::kIndex: return "stamps only count scans: " + made_from_way(plan);
    case ClockFault::kErratic:
      return "stamps do not advance as a clock does: " + made_from_way(plan);
    case ClockFault::kUnit:
      return text("stamps are in %s: converted", name_of_unit(plan.times.unit_s));
    case ClockFault::kCoarse:
      return text("stamps are rounded to %g s: scans are spread evenly within",
                  plan.times.quantum_s);
    case ClockFault::kNoisy:
      return text("stamps of scans are noisy by %.1f ms: taken from the scanner's steady rate",
                  1e3 * plan.times.noise_s);
    case ClockFault::kBackwards: return "stamps run backwards: mirrored";
    case ClockFault::kJumps:
      return text("stamps jump %llu times: bridged by the usual time between scans",
                  static_cast<unsigned long long>(plan.times.jumps));
  }
  return {};
}

void describe_units(const matching::LogCorrection& correction, std::vector<std::string>& findings) {
  const auto add = [&](const char* what, double unit, double thousandth, const char* small,
                       const char* large) {
    if (unit != 1.0)
      findings.push_back(
          text("%s are in %s: converted", what, unit < 3.0 * thousandth ? small : large));
  };
  add("ranges", correction.range_unit_m, 1e-3, "millimetres", "centimetres");
  add("positions of odometry", correction.way_unit_m, 1e-3, "millimetres", "centimetres");
  if (correction.heading_unit_rad != 1.0)
    findings.emplace_back("headings of odometry are in degrees: converted");
}

void describe_signs(const LogPlan& plan, std::vector<std::string>& findings) {
  const matching::LogCorrection& correction = plan.evidence.correction;
  constexpr double kDegrees = 180.0 / 3.14159265358979;
  const std::string pairs = text("%zu pairs of scans", plan.evidence.turning_pairs);
  const std::string doubt =
      plan.evidence.handedness_is_told
          ? ""
          : " (or else beams go clockwise, which looks the same, and the map is mirrored)";
  if (correction.mirrors_position && correction.mirrors_heading)
    findings.push_back("odometry turns with the wrong sign, by " + pairs + ": mirrored" + doubt);
  else if (correction.mirrors_heading)
    findings.push_back("headings of odometry have the wrong sign, by " + pairs + ": mirrored");
  else if (correction.mirrors_position)
    findings.emplace_back(
        "positions of odometry are mirrored or have their axes swapped: mirrored back");
  else if (correction.position_turn_rad != 0.0)
    findings.emplace_back("way by odometry has the wrong sign: turned round");
  if (correction.reverses_beams)
    findings.push_back("beams go clockwise, by " + pairs +
                       ": reversed, as odometry moves on the arcs of its turns (if it is mirrored "
                       "as a whole, so is the map)");
  if (correction.field_factor != 1.0)
    findings.push_back(text("field of view is %.0f degrees, by turns of ",
                            plan.figures.field_of_view_rad * kDegrees) +
                       pairs + ": beams laid out over it");
  if (correction.laser_turn_rad != 0.0)
    findings.push_back(
        text("scanner is mounted turned by %.0f degrees more than the log says: corrected",
             correction.laser_turn_rad * kDegrees));
  const geometry::Pose2 odometry_in_base = inverse(correction.odometry_from_base);
  if (odometry_in_base != geometry::Pose2::identity())
    findings.push_back(
        text("odometry is of a point %.1f m %s and %.1f m %s of the vehicle's: taken from there",
             std::abs(odometry_in_base.x_m), odometry_in_base.x_m < 0.0 ? "behind" : "ahead",
             std::abs(odometry_in_base.y_m), odometry_in_base.y_m < 0.0 ? "right" : "left"));
}

void describe_ranges(const LogPlan& plan, std::vector<std::string>& findings) {
  for (const ScannerPlan& scanner : plan.scanners) {
    if (scanner.refuted_max_range_m == 0.0) continue;
    findings.push_back(
        text("readings%s reach beyond the maximum range of %g m that the log states: taken for "
             "echoes up to %.2f m",
             plan.scanners.size() > 1 ? (" of scanner " + scanner.name).c_str() : "",
             scanner.refuted_max_range_m, scanner.max_range_m));
  }
}

void describe_own_bodies(const LogPlan& plan, std::vector<std::string>& findings) {
  for (const ScannerPlan& scanner : plan.scanners) {
    const std::size_t beams = scanner.own_body.beams();
    if (beams == 0) continue;
    findings.push_back(text(
        "%zu of %zu beams%s see the vehicle itself, at the same distance in nine of ten views: "
        "these echoes are left out",
        beams, scanner.own_body.reach.size(),
        plan.scanners.size() > 1 ? (" of scanner " + scanner.name).c_str() : ""));
  }
}

void describe_gaps(const LogPlan& plan, std::vector<std::string>& findings) {
  constexpr double kLongGap = 10.0;  // periods
  constexpr std::size_t kFewBeams = 32;
  const LogFigures& figures = plan.figures;
  if (plan.repeated_scans > 0)
    findings.push_back(
        text("%llu scans are recorded again, with the same stamp and readings: left "
             "out",
             static_cast<unsigned long long>(plan.repeated_scans)));
  if (plan.scans_are_sorted)
    findings.emplace_back("scans are logged in another order than they were taken in: sorted");
  if (figures.scans_without_readings > 0) {
    findings.push_back(text("%llu of %llu scans hold no reading at all (NaN, infinity or 0)",
                            static_cast<unsigned long long>(figures.scans_without_readings),
                            static_cast<unsigned long long>(figures.scans)));
  }
  if (figures.has_clock && figures.longest_gap_s > 2.0 &&
      figures.longest_gap_s > kLongGap * figures.scan_period_s)
    findings.push_back(text("no scan for %.1f s", figures.longest_gap_s));
  if (figures.are_of_scans && figures.echo_share == 0.0)
    findings.emplace_back("no beam has an echo: odometry alone says how the vehicle moves");
  else if (figures.are_of_scans && figures.echo_share < 0.2)
    findings.push_back(text("only %.0f %% of the beams have an echo", 100.0 * figures.echo_share));
  if (figures.beams > 0 && figures.beams < kFewBeams)
    findings.push_back(
        text("scans of %zu beams are too coarse to tell how the vehicle moves", figures.beams));
}

constexpr double kTold = 0.15;  // least scale error that is reported

bool is_far_off(double scale) { return scale > 0.0 && std::abs(scale - 1.0) > kTold; }

void describe_doubts(const LogPlan& plan, std::vector<std::string>& findings) {
  constexpr double kMostlyMatched = 0.5;
  const matching::LogEvidence& evidence = plan.evidence;
  if (plan.stray_odometry > 0)
    findings.push_back(
        text("%zu poses of odometry are far from those before and after them: left out",
             plan.stray_odometry));
  if (plan.odometry_drift != 0.0)
    findings.push_back(
        text("clocks of odometry and scanner drift apart by %.2f s over the log, odometry is %.2f "
             "s %s in "
             "the middle, by pairs of scans: taken back",
             std::abs(plan.odometry_drift) * plan.figures.duration_s,
             std::abs(plan.odometry_late_s), plan.odometry_late_s > 0.0 ? "late" : "early"));
  else if (plan.odometry_late_s != 0.0)
    findings.push_back(text("odometry is %.2f s %s, by the turns of pairs of scans: taken back",
                            std::abs(plan.odometry_late_s),
                            plan.odometry_late_s > 0.0 ? "late" : "early"));
  if (plan.odometry_held_scans > 0 && plan.odometry != OdometrySource::kNone)
    findings.emplace_back(
        "odometry comes less often than scans, which repeat its last pose: interpolated");
  if (plan.odometry_stamp_noise_s > 0.0)
    findings.push_back(text("stamps of odometry are noisy by %.1f ms: taken from its steady rate",
                            1e3 * plan.odometry_stamp_noise_s));
  if (plan.odometry_smoothed_over > 0)
    findings.push_back(
        text("odometry is noisy or rounded from one pose to the next: smoothed over %zu",
             2 * plan.odometry_smoothed_over + 1));
  if (plan.odometry_is_too_noisy || plan.odometry_is_too_rare)
    findings.push_back(text("odometry %s: not used, scans alone say how the vehicle moves",
                            plan.odometry_is_too_rare
                                ? "comes too seldom"
                                : "is too noisy or rounded from one pose to the next"));
  else if (plan.odometry == OdometrySource::kNone)
    findings.emplace_back("there is no odometry: scans alone say how the vehicle moves");
  if (evidence.pairs > 0 && evidence.matched_share < kMostlyMatched)
    findings.push_back(
        text("only %.0f %% of the sampled pairs of scans match each other: few walls are in view "
             "(trees, open ground), or range unit or field of view is wrong",
             100.0 * evidence.matched_share));
  if (!scans_show_motion(plan))
    findings.emplace_back("scans see too little to judge odometry: it is believed");
  if (is_far_off(evidence.way_scale))
    findings.push_back(
        text("the way by odometry is %.2f times that by scans: corrected by as much to begin with",
             1.0 / evidence.way_scale));
  if (is_far_off(evidence.turn_scale))
    findings.push_back(
        text("turns by odometry are %.2f times those by scans%s", 1.0 / evidence.turn_scale,
             evidence.correction.turn_factor == 1.0 ? "" : ": corrected by as much"));
}

const char* described(OdometrySource source) {
  switch (source) {
    case OdometrySource::kNone: return "none";
    case OdometrySource::kLaserRecords: return "poses in the scans";
    case OdometrySource::kOdomLines: return "ODOM lines";
    case OdometrySource::kBoth: return "poses in the scans and ODOM lines";
  }
  return "";
}

std::string describe_time(const LogPlan& plan) {
  const char* const sources[] = {"ipc_timestamp", "logger_timestamp", "made up"};
  const char* const source = sources[static_cast<std::size_t>(plan.clock)];
  const LogFigures& figures = plan.figures;
  return text("%s, a scan every %.3f s (9 of 10 within %.0f %% of that), longest gap %.1f s",
              source, figures.scan_period_s, 100.0 * figures.scan_period_spread,
              figures.longest_gap_s);
}

std::string describe_profiles_of(const ScannerPlan& scanner) {
  const Eigen::Vector3d& position_m = scanner.profile_mounting->position_in_base_m;
  return scanner.name + text(
                            ": %llu scans from %.2f m ahead, %.2f m left, %.2f m up, for slammot "
                            "model only",
                            static_cast<unsigned long long>(scanner.scans), position_m.x(),
                            position_m.y(), position_m.z());
}

/// Of a bearing in base.
std::string direction_of(double bearing_rad) {
  const double to_the_left_deg = geometry::wrap_angle(bearing_rad) * (180.0 / std::numbers::pi);
  if (std::abs(to_the_left_deg) < 0.5) return "straight ahead";
  return text("%.0f degrees to the %s", std::abs(to_the_left_deg),
              to_the_left_deg < 0.0 ? "right" : "left");
}

}  // namespace

std::string describe_odometry(const LogPlan& plan) {
  const matching::LogEvidence& evidence = plan.evidence;
  std::string line = described(plan.odometry);
  if (plan.odometry == OdometrySource::kNone) return line;
  line += text(", %.0f m", plan.figures.distance_m);
  if (evidence.pairs == 0) return line;
  line += text("; %zu of the sampled pairs of scans match", evidence.pairs);
  if (evidence.way_scale > 0.0)
    line += text(", way by scans %.2f times as long", evidence.way_scale);
  if (evidence.turn_scale > 0.0) line += text(", turns %.2f times", evidence.turn_scale);
  return line;
}

std::string describe_log(const LogPlan& plan) {
  constexpr double kDegrees = 180.0 / 3.14159265358979;
  const LogFigures& figures = plan.figures;
  std::string lines =
      text("scans      %llu of %zu beams over %.0f degrees, %.0f s\n",
           static_cast<unsigned long long>(figures.scans), figures.beams,
           std::floor(figures.field_of_view_rad * kDegrees + 0.25), figures.duration_s);
  lines += "clock      " + describe_time(plan) + "\n";
  lines += text(
      "ranges     half of the echoes within %.1f m, 9 of 10 within %.1f m; no echo from %.2f m on; "
      "%.0f %% of the beams have one\n",
      figures.median_range_m, figures.far_range_m, figures.max_range_m, 100.0 * figures.echo_share);
  lines += "odometry   " + describe_odometry(plan) + "\n";
  if (figures.imu_lines > 0)
    lines += text("imu        %llu readings of the turn rate; a run says what it made of them\n",
                  static_cast<unsigned long long>(figures.imu_lines));
  lines += text("mounting   %.2f m ahead, %.2f m to the left, turned by %.0f degrees\n",
                plan.base_from_laser.x_m, plan.base_from_laser.y_m,
                plan.base_from_laser.heading_rad * kDegrees);
  for (const ScannerPlan& scanner : plan.profile_scanners)
    lines += "vertical   " + describe_profiles_of(scanner) + "\n";
  return lines;
}

std::string likely_causes(const LogPlan& plan) {
  const matching::LogEvidence& evidence = plan.evidence;
  if (takes_floor_for_wall(plan)) return "the scanner looks down at the floor";
  if (plan.odometry == OdometrySource::kNone)
    return "no odometry, and scans too far apart or too much alike";
  if (evidence.pairs > 0 && evidence.matched_share < 0.5)
    return "scans hardly match each other: range unit, field of view or beam order";
  if (evidence.turning_pairs >= 8 && evidence.turn_sign_share > 0.2 &&
      evidence.turn_sign_share < 0.8)
    return "odometry and scans disagree on turns: heading sign, beam order, field of view, unit";
  if (evidence.pairs == 0) return "heading sign, beam order, field of view, unit";
  return "a place without structure, wheels that slip, a jump of the log (heading sign, beam "
         "order, field of view and unit look right)";
}

double way_factor_of(const LogPlan& plan) {
  return is_far_off(plan.evidence.way_scale) ? plan.evidence.way_scale : 1.0;
}

bool scans_show_motion(const LogPlan& plan) {
  constexpr double kFewEchoes = 0.25;
  constexpr double kFewPairs = 0.4;
  const bool sees_little = plan.figures.echo_share < kFewEchoes;
  return plan.evidence.pairs == 0 || !sees_little || plan.evidence.matched_share >= kFewPairs;
}

bool takes_floor_for_wall(const LogPlan& plan) {
  return std::ranges::any_of(
      plan.scanners, [](const ScannerPlan& scanner) { return scanner.floor.is_taken_for_wall(); });
}

std::vector<std::string> describe_floor(const LogPlan& plan) {
  constexpr double kLittle = 0.25;
  std::vector<std::string> findings;
  for (const ScannerPlan& scanner : plan.scanners) {
    const sensing::FloorInView& floor = scanner.floor;
    if (!floor.is_in_view()) continue;
    findings.push_back(
        text("scanner%s looks down: beams meet the floor %.1f m away, %s, in %.0f %% of the views: "
             "%s",
             plan.scanners.size() > 1 ? (" " + scanner.name).c_str() : "", floor.distance_m,
             direction_of(floor.bearing_rad + scanner.base_from_laser.heading_rad).c_str(),
             100.0 * floor.share_of_views,
             floor.is_left_out() ? "echoes there and beyond are left out"
                                 : "taken for a wall until it is found while driving, since only a "
                                   "log that is read twice tells it before"));
    if (floor.share_of_beams < kLittle)
      findings.back() += text("; only %.0f %% of the beams see anything else: mount it level",
                              100.0 * floor.share_of_beams);
  }
  return findings;
}

std::vector<std::string> describe_findings(const LogPlan& plan) {
  std::vector<std::string> findings;
  if (auto clock = describe_clock(plan); !clock.empty()) findings.push_back(std::move(clock));
  describe_units(plan.evidence.correction, findings);
  describe_signs(plan, findings);
  describe_ranges(plan, findings);
  describe_own_bodies(plan, findings);
  for (std::string& floor : describe_floor(plan)) findings.push_back(std::move(floor));
  describe_gaps(plan, findings);
  describe_doubts(plan, findings);
  for (const std::string& name : plan.unplaced_scanners)
    findings.push_back(
        "scanner " + name +
        " is not used: the log does not say where it is mounted (--scanners selects it)");
  return findings;
}

std::string describe_scanners(const LogPlan& plan) {
  std::string lines;
  for (const ScannerPlan& scanner : plan.profile_scanners)
    lines += "vertical: " + describe_profiles_of(scanner) + "\n";
  if (plan.scanners.size() < 2) return lines;
  for (const ScannerPlan& scanner : plan.scanners) {
    const geometry::Pose2& mounting = scanner.base_from_laser;
    lines += "scanner:  " + scanner.name +
             text(": %llu scans, %.2f m ahead, %.2f m left, looks %.0f degrees left\n",
                  static_cast<unsigned long long>(scanner.scans), mounting.x_m, mounting.y_m,
                  mounting.heading_rad * 180.0 / std::numbers::pi);
  }
  return lines;
}

const char* name_of(ClockFault fault) {
  switch (fault) {
    case ClockFault::kNone: return "none";
    case ClockFault::kAbsent: return "absent";
    case ClockFault::kConstant: return "constant";
    case ClockFault::kIndex: return "index";
    case ClockFault::kUnit: return "unit";
    case ClockFault::kCoarse: return "coarse";
    case ClockFault::kNoisy: return "noisy";
    case ClockFault::kBackwards: return "backwards";
    case ClockFault::kJumps: return "jumps";
    case ClockFault::kErratic: return "erratic";
  }
  return "";
}

}  // namespace slammot::files
