#include "common/files/carmen_survey.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace slammot::files {
namespace {

constexpr std::size_t kReadingBins = 65'000;
constexpr double kSecondsPerNanosecond = 1e-9;
constexpr double kFarAhead_s = 60.0;

template <typename Count>
double most_frequent(const std::map<double, Count>& counts) {
  const auto most = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0.0 : most->first;
}

/// Value below which the given share of the values lies; 0 for none.
double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

double distance_m(const geometry::Pose2& a, const geometry::Pose2& b) { return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m); }

bool differ(const geometry::Pose2& a, const geometry::Pose2& b, double metres, double radians) {
  return distance_m(a, b) > metres || std::abs(geometry::wrap_angle(a.heading_rad - b.heading_rad)) > radians;
}

/// Range in metres below which the given share of the first `bins` bins' readings lies.
double range_percentile_m(const std::vector<std::uint32_t>& readings_by_cm, std::size_t bins, double share) {
  const auto end = readings_by_cm.begin() + static_cast<std::ptrdiff_t>(std::min(bins, readings_by_cm.size()));
  const double total = static_cast<double>(std::accumulate(readings_by_cm.begin(), end, std::uint64_t{0}));
  double below = 0.0;
  for (auto bin = readings_by_cm.begin(); bin != end; ++bin) {
    below += *bin;
    if (below > 0.0 && below >= share * total) return 0.01 * static_cast<double>(bin - readings_by_cm.begin());
  }
  return 0.0;
}

}  // namespace

/// A stamp from the future with which a log begins says that all others are too late.
void CarmenSurvey::ClockCheck::begin_anew_without_the_first() {
  sensing::StampGuard of_the_others{kFarAhead_s};
  const std::int64_t second_ns = first_ns_[1];
  const std::int64_t third_ns = first_ns_[2];
  begins_ahead_ = second_ns < third_ns && of_the_others.believes(second_ns) && of_the_others.believes(third_ns) && !of_the_others.believes(first_ns_[0]);
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
    if (first_ns_.size() == 3) begin_anew_without_the_first();
    if (begins_ahead_) return;
  }
  ++scans_;
  if (!stamp_ns || !guard_.believes(*stamp_ns)) return;
  if (newest_ns_ && *stamp_ns > *newest_ns_) {
    ++advancing_;
    steps_ns_.push_back(*stamp_ns - *newest_ns_);
    counts_scans_ = counts_scans_ && steps_ns_.back() == 1'000'000'000 && *stamp_ns % 1'000'000'000 == 0;
  }
  if (!newest_ns_ || *stamp_ns > *newest_ns_) newest_ns_ = stamp_ns;
}

bool CarmenSurvey::ClockCheck::is_usable() const {
  constexpr double kAdvancingShare = 0.9;  // duplicates and a few late scans are the localizer's business
  constexpr double kMinPeriodS = 1e-4;
  constexpr double kMaxPeriodS = 60.0;
  if (scans_ == 0) return false;
  if (scans_ == 1) return newest_ns_.has_value();
  if (counts_scans_ && scans_ > 2) return false;
  if (static_cast<double>(advancing_) < kAdvancingShare * static_cast<double>(scans_ - 1)) return false;
  const double median_s = percentile({steps_ns_.begin(), steps_ns_.end()}, 0.5) * kSecondsPerNanosecond;
  return median_s >= kMinPeriodS && median_s <= kMaxPeriodS;
}

void CarmenSurvey::AgreementCheck::add_odom(const StampedPose& odom) {
  constexpr double kMetM = 0.10;
  constexpr double kMetRad = 0.10;
  for (const StampedPose& laser : waiting_) {
    if (!before_ || laser.stamp_ns < before_->stamp_ns || laser.stamp_ns > odom.stamp_ns) continue;
    const double span_ns = static_cast<double>(odom.stamp_ns - before_->stamp_ns);
    const double fraction = span_ns > 0.0 ? static_cast<double>(laser.stamp_ns - before_->stamp_ns) / span_ns : 0.0;
    ++compared_;
    // What the vehicle moved between the two ODOM lines is what interpolation may be wrong by.
    const double slack_m = kMetM + 0.5 * distance_m(before_->wheel_from_base, odom.wheel_from_base);
    const double slack_rad = kMetRad + 0.5 * std::abs(geometry::wrap_angle(odom.wheel_from_base.heading_rad - before_->wheel_from_base.heading_rad));
    if (!differ(geometry::interpolate(before_->wheel_from_base, odom.wheel_from_base, fraction), laser.wheel_from_base, slack_m, slack_rad)) ++met_;
  }
  waiting_.clear();
  before_ = odom;
}

void CarmenSurvey::AgreementCheck::add_laser(const StampedPose& laser) {
  constexpr std::size_t kMaxWaiting = 64;
  if (waiting_.size() < kMaxWaiting) waiting_.push_back(laser);
}

bool CarmenSurvey::AgreementCheck::agrees() const {
  constexpr double kMetShare = 0.95;
  return compared_ > 0 && static_cast<double>(met_) >= kMetShare * static_cast<double>(compared_);
}

void CarmenSurvey::add(const CarmenRecord& record) {
  if (const auto* laser = std::get_if<LaserRecord>(&record)) add_laser(*laser);
  if (const auto* odom = std::get_if<OdometryRecord>(&record)) add_odom(*odom);
  if (const auto* param = std::get_if<ParamRecord>(&record)) add_param(*param);
}

void CarmenSurvey::add_laser(const LaserRecord& record) {
  Lasers& lasers = lasers_[static_cast<std::size_t>(record.kind)];
  ++lasers.scans;
  ++lasers.scans_by_beams[record.range_m.size()];
  if (record.max_range_m > 0.0) ++lasers.scans_by_recorded_max_range[record.max_range_m];
  if (!lasers.layout) lasers.layout = record.layout;
  lasers.readings_by_cm.resize(kReadingBins);
  lasers.smallest_reading_by_cm.resize(kReadingBins, std::numeric_limits<float>::infinity());
  for (const float reading_m : record.range_m) {
    const float reading_cm = reading_m * 100.0F + 0.5F;
    if (!(reading_cm >= 1.0F && reading_cm < static_cast<float>(kReadingBins))) continue;
    const auto bin = static_cast<std::size_t>(reading_cm);
    ++lasers.readings_by_cm[bin];
    lasers.smallest_reading_by_cm[bin] = std::min(lasers.smallest_reading_by_cm[bin], reading_m);
  }
  if (record.base_from_laser) {
    if (!lasers.base_from_laser) lasers.base_from_laser = record.base_from_laser;
    lasers.base_from_laser_is_constant = lasers.base_from_laser_is_constant && !differ(*lasers.base_from_laser, *record.base_from_laser, 0.01, 0.01);
  }
  const StampedPose pose{record.stamps.ipc_ns.value_or(0), record.wheel_from_base};
  lasers.pose_changes = lasers.pose_changes || (!lasers.poses.empty() && differ(lasers.poses.front().wheel_from_base, record.wheel_from_base, 1e-9, 1e-9));
  lasers.poses.push_back(pose);
  lasers.logger_ns.push_back(record.stamps.logger_ns.value_or(0));
  lasers.ipc_clock.add(record.stamps.ipc_ns);
  lasers.logger_clock.add(record.stamps.logger_ns);
  if (record.stamps.ipc_ns) lasers.agreement.add_laser(pose);
}

void CarmenSurvey::add_odom(const OdometryRecord& record) {
  ++odom_lines_;
  if (!first_odom_pose_) first_odom_pose_ = record.wheel_from_base;
  odom_pose_changes_ = odom_pose_changes_ || differ(*first_odom_pose_, record.wheel_from_base, 1e-9, 1e-9);
  if (!record.stamps.ipc_ns) return;
  for (Lasers& lasers : lasers_) lasers.agreement.add_odom({*record.stamps.ipc_ns, record.wheel_from_base});
}

void CarmenSurvey::add_param(const ParamRecord& record) {
  double value = 0.0;
  const auto [end, fault] = std::from_chars(record.value.data(), record.value.data() + record.value.size(), value);
  if (fault != std::errc() || !(std::abs(value) < 100.0)) return;
  if (record.name == "robot_frontlaser_offset") laser_offset_params_[0] = value;
  if (record.name == "robot_frontlaser_side_offset") laser_offset_params_[1] = value;
  if (record.name == "robot_frontlaser_angular_offset") laser_offset_params_[2] = value;
}

LogPlan CarmenSurvey::conclude(double fallback_field_of_view_rad) const {
  LogPlan plan;
  plan.laser = lasers_[1].scans >= lasers_[0].scans ? LaserRecordKind::kRobotLaser1 : LaserRecordKind::kFlaser;
  const Lasers& lasers = lasers_[static_cast<std::size_t>(plan.laser)];
  plan.clock = lasers.ipc_clock.is_usable() ? LogClock::kIpc : lasers.logger_clock.is_usable() ? LogClock::kLogger : LogClock::kNominal;
  plan.first_scan_is_ahead = (plan.clock == LogClock::kIpc && lasers.ipc_clock.begins_ahead()) || (plan.clock == LogClock::kLogger && lasers.logger_clock.begins_ahead());
  plan.odometry = odometry_source(lasers, plan.clock);
  plan.base_from_laser = base_from_laser(lasers);
  plan.max_range_m = max_range_m(lasers);
  plan.figures = figures(lasers, plan, fallback_field_of_view_rad);
  return plan;
}

/// "No echo" is a reading that repeats at the far end: some scanners have several such codes within a percent
/// (LMS: 81.83, 81.90, 81.91), the smallest of them counts. Where the far end does not repeat, every reading is an
/// echo. A record's own maximum holds unless the data have a code below it.
double CarmenSurvey::max_range_m(const Lasers& lasers) {
  constexpr double kCodeShare = 1e-3;      // of all readings
  constexpr std::uint64_t kCodeCount = 5;
  const double recorded_m = most_frequent(lasers.scans_by_recorded_max_range);
  const auto& counts = lasers.readings_by_cm;
  const auto last = std::find_if(counts.rbegin(), counts.rend(), [](std::uint32_t count) { return count > 0; });
  if (last == counts.rend()) return recorded_m > 0.0 ? recorded_m : 1.0;
  const auto last_bin = static_cast<std::size_t>(counts.rend() - last) - 1;
  const double total = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}));
  const auto is_code = [&](std::size_t bin) { return counts[bin] >= kCodeCount && counts[bin] >= kCodeShare * total; };
  for (std::size_t bin = last_bin - last_bin / 100; bin <= last_bin; ++bin) {
    if (!is_code(bin)) continue;
    const double code_m = static_cast<double>(lasers.smallest_reading_by_cm[bin]);
    return recorded_m > 0.0 ? std::min(recorded_m, code_m) : code_m;
  }
  return recorded_m > 0.0 ? recorded_m : 0.01 * static_cast<double>(last_bin + 1);
}

OdometrySource CarmenSurvey::odometry_source(const Lasers& lasers, LogClock clock) const {
  if (!lasers.pose_changes) return odom_pose_changes_ ? OdometrySource::kOdomLines : OdometrySource::kNone;
  const bool odom_lines_fit = clock == LogClock::kIpc && odom_pose_changes_ && lasers.agreement.agrees();
  return odom_lines_fit ? OdometrySource::kBoth : OdometrySource::kLaserRecords;
}

geometry::Pose2 CarmenSurvey::base_from_laser(const Lasers& lasers) const {
  const auto& [x_m, y_m, heading_rad] = laser_offset_params_;
  if (x_m || y_m || heading_rad) return {x_m.value_or(0.0), y_m.value_or(0.0), heading_rad.value_or(0.0)};
  if (lasers.base_from_laser && lasers.base_from_laser_is_constant) return *lasers.base_from_laser;
  return geometry::Pose2::identity();
}

LogFigures CarmenSurvey::figures(const Lasers& lasers, const LogPlan& plan, double fallback_field_of_view_rad) const {
  LogFigures figures;
  figures.scans = lasers.scans;
  figures.odom_lines = odom_lines_;
  figures.has_clock = plan.clock != LogClock::kNominal;
  if (lasers.scans == 0) return figures;
  std::map<double, std::uint64_t> scans_by_beams(lasers.scans_by_beams.begin(), lasers.scans_by_beams.end());
  figures.beams = static_cast<std::size_t>(most_frequent(scans_by_beams));
  const BeamLayout layout = lasers.layout.value_or(layout_by_convention(figures.beams, fallback_field_of_view_rad));
  figures.field_of_view_rad = std::min(layout.beam_step_rad * static_cast<double>(figures.beams), 2.0 * std::numbers::pi);
  figures.max_range_m = plan.max_range_m;
  const auto echo_bins = static_cast<std::size_t>(std::max(0.0, plan.max_range_m * 100.0 + 0.5));
  figures.median_range_m = range_percentile_m(lasers.readings_by_cm, echo_bins, 0.5);
  figures.far_range_m = range_percentile_m(lasers.readings_by_cm, echo_bins, 0.9);
  std::vector<double> periods_s;
  std::vector<double> speeds_mps;
  for (std::size_t i = 1; i < lasers.poses.size(); ++i) {
    const double step_m = distance_m(lasers.poses[i - 1].wheel_from_base, lasers.poses[i].wheel_from_base);
    figures.distance_m += step_m;
    const std::int64_t period_ns = plan.clock == LogClock::kIpc ? lasers.poses[i].stamp_ns - lasers.poses[i - 1].stamp_ns
                                                                : lasers.logger_ns[i] - lasers.logger_ns[i - 1];
    if (plan.clock == LogClock::kNominal || period_ns <= 0) continue;
    periods_s.push_back(static_cast<double>(period_ns) * kSecondsPerNanosecond);
    speeds_mps.push_back(step_m / periods_s.back());
  }
  figures.scan_period_s = plan.clock == LogClock::kNominal ? 1.0 / kNominalRateHz : percentile(periods_s, 0.5);
  if (figures.scan_period_s > 0.0 && !periods_s.empty()) {
    figures.scan_period_spread = (percentile(periods_s, 0.9) - percentile(periods_s, 0.1)) / figures.scan_period_s;
  }
  figures.duration_s = plan.clock == LogClock::kNominal ? static_cast<double>(figures.scans - 1) / kNominalRateHz
                                                        : std::accumulate(periods_s.begin(), periods_s.end(), 0.0);
  figures.cruising_speed_mps = percentile(speeds_mps, 0.9);
  return figures;
}

}  // namespace slammot::files
